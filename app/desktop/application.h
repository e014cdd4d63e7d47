#pragma once

#include <QObject>
#include <QStringList>
#include <memory>
#include <optional>

#include "app/desktop/device_source.h"
#include "app/desktop/servo_controller.h"
#include "core/session/session.h"
#include "ui/shell/main_window.h"

namespace nearfit::desktop {

/// Composition root of the desktop application: owns session, servo and window, and connects them.
/// Needs the QApplication.
class Application : public QObject {
  Q_OBJECT

 public:
  /// @param devices  Null: the devices that are plugged in.
  explicit Application(std::unique_ptr<DeviceSource> devices = nullptr);
  ~Application() override;

  /// Set up Qt: prepare() before the QApplication is made, configure() after.
  static void prepare();
  static void configure();

  /// Shows the window, then opens the files, or the demo scene if `isDemo`. The very first run without files
  /// shows the demo scene with the tour.
  /// @param metresPerUnit, tessellation  As for Document::openFiles().
  void show(const QStringList& files, bool isDemo, std::optional<double> metresPerUnit = std::nullopt,
            const std::optional<Tessellation>& tessellation = std::nullopt);

  /// Shows the window and replays a script in it. A line that fails is shown as a failure; the scene is then as before
  /// that line. Blocks while meshes load.
  void replayScript(const QString& file);

  Session& session() noexcept { return session_; }
  ui::MainWindow& window() noexcept { return window_; }
  ServoController& servo() noexcept { return servo_; }
  DeviceWatcher& watcher() noexcept { return watcher_; }
  DeviceSource& devices() noexcept { return *devices_; }

 private:
  void wire();
  /// Connects what the window asks the servo to do.
  void wireRequests();
  /// Connects what servo and devices report to the window.
  void wireReports();

  Session session_;
  std::unique_ptr<DeviceSource> devices_;
  ServoController servo_;
  DeviceWatcher watcher_;
  ui::MainWindow window_;
};

/// Check for a display and for OpenGL 3.2 before Qt and VTK do, which end the process without them. Throw
/// Error with the remedy. requireDisplay() needs no QApplication; requireOpenGl() does.
void requireDisplay();
void requireOpenGl();

}  // namespace nearfit::desktop
