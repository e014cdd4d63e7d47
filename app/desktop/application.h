#pragma once

#include <QObject>
#include <QStringList>

#include "app/desktop/servo_controller.h"
#include "core/session.h"
#include "ui/main_window.h"

namespace nearfit::desktop {

/// The desktop application's composition root: owns session, servo and window, and wires them.
/// Needs the QApplication.
class Application : public QObject {
  Q_OBJECT

 public:
  Application();
  ~Application() override;

  /// What must be set up before the QApplication is made, and once after.
  static void prepare();
  static void configure();

  Session& session() noexcept { return session_; }
  ui::MainWindow& window() noexcept { return window_; }
  ServoController& servo() noexcept { return servo_; }

 private:
  void wire();

  Session session_;
  ServoController servo_;
  ui::MainWindow window_;
};

}  // namespace nearfit::desktop
