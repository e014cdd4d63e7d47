#pragma once

#include <QObject>
#include <QStringList>
#include <memory>

#include "app/desktop/device_watcher.h"
#include "app/desktop/servo_controller.h"
#include "core/session.h"
#include "ui/main_window.h"

namespace nearfit::desktop {

/// The desktop application's composition root: owns session, servo and window, and wires them.
/// Needs the QApplication.
class Application : public QObject {
  Q_OBJECT

 public:
  /// @param devices  Null: those that are plugged in.
  explicit Application(std::unique_ptr<DeviceSource> devices = nullptr);
  ~Application() override;

  /// What must be set up before the QApplication is made, and once after.
  static void prepare();
  static void configure();

  /// Shows the window, then opens what is to be seen in it. The very first time and without files that is the
  /// demo scene, with the tour.
  void show(const QStringList& files, bool isDemo);

  Session& session() noexcept { return session_; }
  ui::MainWindow& window() noexcept { return window_; }
  ServoController& servo() noexcept { return servo_; }
  DeviceWatcher& watcher() noexcept { return watcher_; }
  DeviceSource& devices() noexcept { return *devices_; }

 private:
  void wire();

  Session session_;
  std::unique_ptr<DeviceSource> devices_;
  ServoController servo_;
  DeviceWatcher watcher_;
  ui::MainWindow window_;
};

}  // namespace nearfit::desktop
