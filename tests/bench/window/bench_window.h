#pragma once

#include <QTimer>
#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "app/desktop/application.h"
#include "core/scene/scene.h"
#include "ui/view3d/viewport.h"

namespace nearfit::bench {

/// Milliseconds by the wall clock, from some beginning.
double milliseconds();
/// Handles events until it is done. @throw Error after two minutes.
void waitUntil(const char* what, const std::function<bool()>& isDone);
/// Of all parts together.
std::size_t trianglesOf(const Scene& scene);
/// Times the triangles of a scene, a budget that leaves nothing out: lines count too.
constexpr std::size_t kWholeScene = 10;

/// What is 1280 pixels wide and 800 high.
enum class Sized { View, Window };

/// The application that ships, driven as a user does; its view is sized at first.
class BenchWindow {
 public:
  BenchWindow();
  ~BenchWindow();

  desktop::Application& application() noexcept { return *application_; }
  ui::Viewport& view() { return application_->window().viewport(); }
  void resize(Sized what);
  void open(Scene scene);
  void startServo();
  void stopServo();

  /// Handles events for so long.
  static void run(std::chrono::milliseconds time);
  /// Handles events until the view has drawn all that it will, and draws nothing more. @throw Error when it
  /// goes on and on.
  void settle();
  /// Does something and waits until a picture after it is on the screen. @return How long that took [ms].
  double shown(const std::function<void()>& act);
  /// Turns the camera by the mouse for so long. @return Of each step, how long until it was shown [ms].
  std::vector<double> orbit(std::chrono::milliseconds time);

 private:
  std::unique_ptr<desktop::Application> application_;
  int swaps_ = 0;
};

/// How long the window lets an event wait, from construction on.
class Heartbeat {
 public:
  Heartbeat();
  /// Of each event, how long it waited [ms].
  std::vector<double> waits;

 private:
  static constexpr int kEveryMs = 2;
  QTimer timer_;
  double last_;
};

}  // namespace nearfit::bench
