#include "app/desktop/servo_controller.h"

#include <exception>

#include "app/desktop/hands.h"
#include "device/simulated_device.h"

namespace nearfit::desktop {
namespace {

constexpr int kPollMs = 16;         ///< A look at the newest snapshot for each picture of a 60 Hz display.
constexpr qint64 kMeasureMs = 500;  ///< Rate and percentiles are read this often.

/// What counts for a hand: the manual one gives poses of the scene itself, already without what is locked.
ServoParameters parametersFor(const Scene& scene, const HapticDevice& device, ui::Hand hand) {
  ServoParameters parameters{scene.haptics(), device.info().limits};
  if (hand == ui::Hand::Manual) parameters.haptics.mapping = {};
  return parameters;
}

}  // namespace

ServoController::ServoController(Session& session) : session_(session) {
  timer_.setTimerType(Qt::PreciseTimer);
  timer_.setInterval(kPollMs);
  connect(&timer_, &QTimer::timeout, this, &ServoController::poll);
  session_.onChange([this] { followSession(); });
}

ServoController::~ServoController() {
  loop_.stop();
}

void ServoController::start(ui::Hand hand) {
  if (isRunning()) return;
  try {
    take(hand);
  } catch (...) {
    emit failed(ui::describe(tr("The part could not be taken in hand."), std::current_exception()));
    return;
  }
  status_ = {};
  status_.isRunning = true;
  status_.hand = hand;
  status_.device = device_->info().limits;
  status_.nominalRate = 1.0 / ServoLoop::kPeriod;
  status_.scheduling = QString::fromStdString(loop_.schedulingNote());
  sinceMeasured_.start();
  timer_.start();
  emit statusChanged(status_);
}

void ServoController::take(ui::Hand hand) {
  const Scene& scene = session_.scene();
  auto servoScene = makeServoScene(scene);
  moving_ = servoScene->moving.id;
  mode_ = scene.haptics().mode;
  auto device = makeHand(hand, *servoScene, scene.haptics());
  loop_.stop();
  loop_.start(*device, std::move(servoScene), parametersFor(scene, *device, hand));
  device_ = std::move(device);
  ticksMeasured_ = 0;
}

void ServoController::stop() {
  if (!isRunning()) return;
  loop_.stop();
  commitPose();
  halt();
}

void ServoController::halt() {
  timer_.stop();
  loop_.stop();
  device_.reset();
  status_ = {};
  emit statusChanged(status_);
}

void ServoController::commitPose() {
  if (!isRunning()) return;
  loop_.pollSnapshot();
  const ServoSnapshot& snapshot = loop_.snapshot();
  if (snapshot.tick == 0 || !snapshot.proxy.isFinite()) return;
  isCommitting_ = true;
  try {
    session_.movePart(moving_, snapshot.proxy, "Feel");
  } catch (...) {
    emit failed(ui::describe(tr("The part's place could not be kept."), std::current_exception()));
  }
  isCommitting_ = false;
}

void ServoController::moveHand(const RigidTransform& worldFromPart) {
  if (auto* manual = dynamic_cast<ManualDevice*>(device_.get())) manual->setPose(worldFromPart);
}

void ServoController::followSession() {
  if (!isRunning() || isCommitting_) return;
  const Scene& scene = session_.scene();
  const Part* part = scene.find(moving_);
  // What was in hand is gone or no longer what moves: there is no pose to keep.
  if (part == nullptr || scene.movingPart() != moving_) {
    halt();
    return;
  }
  if (!areHierarchiesReady(scene.geometries())) {
    emit hierarchiesNeeded();
    return;
  }
  try {
    // What the scripted hand does in one mode would go through in the other: it begins again.
    if (status_.hand == ui::Hand::Scripted && scene.haptics().mode != mode_) {
      take(status_.hand);
      return;
    }
    loop_.setScene(makeServoScene(scene));
    loop_.setParameters(parametersFor(scene, *device_, status_.hand));
  } catch (...) {
    halt();
    emit failed(ui::describe(tr("The servo was stopped."), std::current_exception()));
  }
}

void ServoController::poll() {
  if (loop_.pollSnapshot()) {
    const ServoSnapshot& snapshot = loop_.snapshot();
    if (ticksMeasured_ == 0) {
      ticksMeasured_ = snapshot.tick;
      timeMeasured_ = snapshot.time;
    }
    emit snapshotArrived(snapshot);
  }
  if (!loop_.isRunning()) {
    stop();
    return;
  }
  if (sinceMeasured_.elapsed() >= kMeasureMs) measure();
}

void ServoController::measure() {
  sinceMeasured_.restart();
  const ServoStatistics statistics = loop_.statistics();
  // From snapshots: the statistics come in steps of many ticks, a tenth of what half a second holds.
  const ServoSnapshot& snapshot = loop_.snapshot();
  const double seconds = snapshot.time - timeMeasured_;
  status_.rate = seconds > 0.0 ? static_cast<double>(snapshot.tick - ticksMeasured_) / seconds : 0.0;
  ticksMeasured_ = snapshot.tick;
  timeMeasured_ = snapshot.time;
  status_.ticks = statistics.ticks;
  status_.overruns = statistics.overruns;
  status_.latenessP99 = statistics.lateness.percentile(0.99);
  status_.latenessMax = statistics.lateness.max();
  status_.tickP99 = statistics.tickTime.percentile(0.99);
  status_.queryP99 = statistics.queryTime.percentile(0.99);
  emit statusChanged(status_);
}

}  // namespace nearfit::desktop
