#include "tests/bench/window/bench_window.h"

#include <QApplication>
#include <QMouseEvent>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "tests/bench/bench_clock.h"
#include "ui/files/document.h"
#include "ui/view3d/view_detail.h"

namespace nearfit::bench {
namespace {

constexpr int kWidth = 1280, kHeight = 800;
constexpr double kPatience = 120'000.0;  ///< [ms]

/// Tests run on machines with devices too.
class NoDevices final : public desktop::DeviceSource {
 public:
  bool hasChanged() override { return false; }
  QVector<ui::DeviceChoice> list() override { return {}; }
  QString find(const QString&) override { throw Error("devices", "there are none"); }
  std::unique_ptr<HapticDevice> make(const QString&) override { throw Error("devices", "there are none"); }
};

void send(QWidget& widget, QEvent::Type type, const QPoint& at) {
  const bool isMove = type == QEvent::MouseMove;
  const Qt::MouseButtons held = type == QEvent::MouseButtonRelease ? Qt::NoButton : Qt::LeftButton;
  QMouseEvent event(type, at, widget.mapToGlobal(at), isMove ? Qt::NoButton : Qt::LeftButton, held,
                    Qt::NoModifier);
  QApplication::sendEvent(&widget, &event);
}

}  // namespace

double milliseconds() {
  return 1e3 * secondsBy(BenchClock::Wall);
}

std::size_t trianglesOf(const Scene& scene) {
  std::size_t all = 0;
  for (const Scene::PartPtr& part : scene.parts())
    all += part->geometry->mesh.triangles().size();
  return all;
}

void waitUntil(const char* what, const std::function<bool()>& isDone) {
  const double start = milliseconds();
  // Where no event comes, patience ends all the same.
  QTimer look;
  look.start(1000);
  while (!isDone()) {
    if (milliseconds() - start > kPatience) throw Error("window", std::string("waits in vain for ") + what);
    QApplication::processEvents(QEventLoop::WaitForMoreEvents);
  }
}

BenchWindow::BenchWindow()
    : application_(std::make_unique<desktop::Application>(std::make_unique<NoDevices>())) {
  ui::MainWindow& window = application_->window();
  window.setFailureSink([](const ui::Failure& failure) {
    throw Error("window", failure.summary.toStdString() + ": " + failure.details.toStdString());
  });
  QObject::connect(&view(), &QOpenGLWidget::frameSwapped, application_.get(), [this] { ++swaps_; });
  window.resize(kWidth, kHeight);
  window.show();
  waitUntil("its first picture", [this] { return swaps_ > 0; });
  resize(Sized::View);
}

BenchWindow::~BenchWindow() = default;

void BenchWindow::resize(Sized what) {
  ui::MainWindow& window = application_->window();
  window.resize(what == Sized::Window ? QSize(kWidth, kHeight)
                                      : window.size() + QSize(kWidth, kHeight) - view().size());
  settle();
}

void BenchWindow::open(Scene scene) {
  application_->session().reset(std::move(scene), {});
  settle();
}

void BenchWindow::startServo() {
  bool isReady = false;
  application_->window().document().prepareHierarchies([&](bool is) { isReady = is; });
  waitUntil("hierarchies", [&] { return isReady; });
  application_->servo().start(ui::Hand::Scripted);
  waitUntil("the servo", [&] { return application_->servo().status().ticks > 0; });
}

void BenchWindow::stopServo() {
  application_->servo().stop();
}

void BenchWindow::run(std::chrono::milliseconds time) {
  QEventLoop loop;
  QTimer::singleShot(time, Qt::PreciseTimer, &loop, &QEventLoop::quit);
  loop.exec();
}

void BenchWindow::settle() {
  // What is wanted but not drawn yet comes in this time.
  constexpr std::chrono::milliseconds kWhile{500};
  const double start = milliseconds();
  int before = -1;
  while (std::exchange(before, view().pictureCount()) != view().pictureCount() ||
         !view().detail().isSettled() || !application_->window().document().hasAllShapes()) {
    if (milliseconds() - start > kPatience) throw Error("window", "it draws without end");
    run(kWhile);
  }
}

double BenchWindow::shown(const std::function<void()>& act) {
  const int swaps = swaps_, pictures = view().pictureCount();
  const double start = milliseconds();
  act();
  waitUntil("a picture", [&] { return view().pictureCount() > pictures && swaps_ > swaps; });
  return milliseconds() - start;
}

std::vector<double> BenchWindow::orbit(std::chrono::milliseconds time) {
  std::vector<double> frames;
  const QPoint centre = view().rect().center();
  send(view(), QEvent::MouseButtonPress, centre);
  const double end = milliseconds() + static_cast<double>(time.count());
  for (int step = 1; milliseconds() < end; ++step) {
    // Round and round near the middle.
    const double angle = 0.15 * step;
    const QPoint at = centre + QPoint(static_cast<int>(std::lround(150.0 * std::sin(angle))),
                                      static_cast<int>(std::lround(150.0 * (1.0 - std::cos(angle)))));
    frames.push_back(shown([&] { send(view(), QEvent::MouseMove, at); }));
  }
  send(view(), QEvent::MouseButtonRelease, centre + QPoint(40, 40));
  return frames;
}

Heartbeat::Heartbeat() : last_(milliseconds()) {
  timer_.setTimerType(Qt::PreciseTimer);
  QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] {
    const double now = milliseconds();
    waits.push_back(std::max(0.0, now - last_ - kEveryMs));
    last_ = now;
  });
  timer_.start(kEveryMs);
}

}  // namespace nearfit::bench
