#include "app/desktop/servo_controller.h"

#include <QFileInfo>
#include <exception>
#include <utility>
#include <vector>

#include "app/desktop/hands.h"
#include "core/scene/moving_body.h"
#include "core/servo/start_apart.h"
#include "device/common/rate_control.h"
#include "device/interface/device_error.h"
#include "device/simulated/replay_device.h"
#include "device/simulated/simulated_device.h"

namespace nearfit::desktop {
namespace {

constexpr int kPollMs = 16;  ///< One look for each picture of a 60 Hz display.

/// Returns the parameters for a device: some give poses of the scene itself, to which scale and
/// locks were applied.
ServoParameters parametersFor(const Scene& scene, const HapticDevice& device) {
  const DeviceInfo info = device.info();
  ServoParameters parameters{scene.haptics(), info.limits};
  if (!info.isMapped) parameters.haptics.mapping = {};
  return parameters;
}

}  // namespace

ServoController::ServoController(Session& session, DeviceSource& devices)
    : session_(session), devices_(devices) {
  timer_.setTimerType(Qt::PreciseTimer);
  timer_.setInterval(kPollMs);
  connect(&timer_, &QTimer::timeout, this, &ServoController::poll);
  connect(&rows_, &ServoRows::failed, this,
          [this](const std::exception_ptr& error, const QString& file, double seconds) {
            fail(file.isEmpty() ? tr("The motion could not be recorded.")
                                : tr("The recording stopped after %1 s. %2 contains everything up to then.")
                                      .arg(seconds, 0, 'f', 1)
                                      .arg(QFileInfo(file).fileName()),
                 error);
          });
  changes_ = session_.onChange(SceneEvents::Stage::Application, [this] { followSession(); });
}

ServoController::~ServoController() {
  loop_.stop();
  if (device_) release();
}

void ServoController::fail(const QString& summary, const std::exception_ptr& error) {
  emit failed(ui::describe(summary, error));
}

void ServoController::start(ui::Hand hand, const QString& device) {
  if (status_.isTaken()) return;
  try {
    status_ = {};
    status_.hand = hand;
    if (hand == ui::Hand::Device) {
      open(device);
      return;
    }
    std::unique_ptr<const ServoScene> scene = startScene();
    DevicePtr made = startedHand(*scene);
    runOn(std::move(made), std::move(scene));
  } catch (...) {
    status_ = {};
    fail(tr("The part could not be taken in hand."), std::current_exception());
    return;
  }
  showRunning();
}

std::unique_ptr<ServoScene> ServoController::servoScene() const {
  const Scene& scene = session_.scene();
  auto made = makeServoScene(scene);
  if (!guidance_ || scene.get(made->moving.id).name != guidance_->parts.front()) return made;
  std::vector<GuidancePose> way = wayOf(*guidance_, made->centreInPart);
  if (way.size() > 1)
    made->guidance = std::make_shared<const GuidancePath>(std::move(way), GuidanceSettings{});
  return made;
}

std::unique_ptr<ServoScene> ServoController::startScene(const std::optional<RigidTransform>& start) const {
  auto made = servoScene();
  if (start) made->moving.worldFromPart = *start;
  if (session_.scene().haptics().mode == HapticMode::Proxy) startApart(*made);
  return made;
}

void ServoController::setGuidance(const std::shared_ptr<const AssemblyPath>& path) {
  guidance_ = path;
  if (!isRunning() || session_.scene().movingPart() != moving_ || !isReadyToFeel(session_.scene())) return;
  try {
    loop_.setScene(servoScene());
  } catch (...) {
    guidance_.reset();
    fail(tr("The hand cannot be guided."), std::current_exception());
  }
}

ServoController::DevicePtr ServoController::startedHand(const ServoScene& scene) const {
  DevicePtr made = makeHand(status_.hand, scene, session_.scene().haptics());
  made->start(scene.moving.worldFromPart);
  return made;
}

void ServoController::open(const QString& id) {
  const Scene& scene = session_.scene();
  const Part* part = scene.movingPart() ? scene.find(*scene.movingPart()) : nullptr;
  if (part == nullptr) throw UsageError("servo", "there is no part to take in hand", "choose one");
  const auto recording = recordingOf(id);
  device_ = recording ? std::make_unique<ReplayDevice>(*recording) : devices_.make(id);
  setRate(rate_);
  status_.isOpening = true;
  status_.deviceId = id;
  status_.deviceState = tr("Opening…");
  const auto job = [device = device_, pose = part->worldFromPart](const ProgressCallback& progress) {
    device->start(pose, progress);
  };
  const auto done = [this](const std::exception_ptr& error) {
    ticket_.reset();
    isOpened_ = !error;
    if (!error) return takeOpened();
    halt();
    fail(tr("The part could not be taken in hand."), error);
  };
  const auto progressed = [this](double fraction) {
    status_.openingFraction = fraction;
    emit statusChanged(status_);
  };
  ticket_ = worker_.run(job, {done, progressed});
  emit statusChanged(status_);
}

void ServoController::takeOpened() {
  const Scene& scene = session_.scene();
  if (!isReadyToFeel(scene)) {
    emit hierarchiesNeeded();
    return;
  }
  isOpened_ = false;
  try {
    runOn(device_, startScene());
  } catch (...) {
    halt();
    fail(tr("The part could not be taken in hand."), std::current_exception());
    return;
  }
  showRunning();
}

void ServoController::runOn(DevicePtr device, std::unique_ptr<const ServoScene> servoScene) {
  const Scene& scene = session_.scene();
  const ServoParameters parameters = parametersFor(scene, *device);
  moving_ = servoScene->moving.id;
  movingGroup_ = scene.movingGroup();
  startPose_ = servoScene->moving.worldFromPart;
  sceneSerial_ = session_.sceneSerial();
  mode_ = scene.haptics().mode;
  loop_.stop();
  rows_.begin();
  loop_.startWithOpen(*device, std::move(servoScene), parameters, rows_.queue());
  loopDevice_ = device_ = std::move(device);
  meter_.restart(loopDevice_->counters());
}

void ServoController::showRunning() {
  status_.isRunning = true;
  status_.isOpening = false;
  status_.deviceState.clear();
  takeDeviceState();
  status_.device = device_->info().limits;
  status_.nominalRate = 1.0 / ServoLoop::kPeriod;
  status_.scheduling = QString::fromStdString(loop_.schedulingNote());
  timer_.start();
  emit statusChanged(status_);
}

void ServoController::stop() {
  if (!status_.isTaken()) return;
  loop_.stop();
  commitPose();
  halt();
}

void ServoController::halt() {
  timer_.stop();
  loop_.stop();
  rows_.finish();
  loopDevice_.reset();
  if (device_) release();
  status_ = {};
  emit statusChanged(status_);
}

void ServoController::recordTo(const QString& file) {
  rows_.recordTo(file, isRunning());
}

void ServoController::release() {
  if (ticket_) ticket_->cancel();
  ticket_.reset();
  isOpened_ = false;
  const auto done = [this, id = status_.deviceId](const std::exception_ptr&) {
    // The device may have been taken again meanwhile.
    if (status_.deviceId != id) emit deviceReleased(id);
  };
  worker_.run([device = std::move(device_)](const ProgressCallback&) { device->stop(); }, {done, {}});
  device_.reset();
}

void ServoController::commitPose() {
  if (!isRunning()) return;
  // After a stop, the tick whose pose is kept is shown.
  showNewest();
  const ServoSnapshot& snapshot = loop_.snapshot();
  const RigidTransform pose = snapshot.tick == 0 ? startPose_ : snapshot.proxy;
  if (!pose.isFinite() || session_.scene().movingPart() != moving_) return;
  isCommitting_ = true;
  try {
    session_.moveMoving(pose, "Feel");
  } catch (...) {
    fail(tr("The part's new pose could not be kept."), std::current_exception());
  }
  isCommitting_ = false;
}

void ServoController::moveHand(const RigidTransform& worldFromPart) {
  if (auto* manual = dynamic_cast<ManualDevice*>(loopDevice_.get())) manual->setPose(worldFromPart);
}

void ServoController::command(const QString& doing, const QString& what,
                              std::function<void(HapticDevice&)> act) {
  if (!isRunning() || status_.hand != ui::Hand::Device) return;
  const auto done = [this, what](const std::exception_ptr& error) {
    ticket_.reset();
    status_.isBusy = false;
    takeDeviceState();
    emit statusChanged(status_);
    if (error) fail(what, error);
  };
  // Jobs submitted before run first; only the last one counts for what is shown.
  if (ticket_) ticket_->cancel();
  ticket_ = worker_.run([device = device_, act = std::move(act)](const ProgressCallback&) { act(*device); },
                        {done, {}});
  status_.isBusy = true;
  status_.deviceState = doing;
  emit statusChanged(status_);
}

void ServoController::setArmed(bool isArmed) {
  command(isArmed ? tr("Arming…") : tr("Disarming…"),
          isArmed ? tr("The device could not be armed.") : tr("The device could not be disarmed."),
          [isArmed](HapticDevice& device) { isArmed ? device.arm() : device.disarm(); });
}

void ServoController::calibrate() {
  command(tr("Calibrating…"), tr("The device could not be calibrated."),
          [](HapticDevice& device) { device.calibrate(); });
}

void ServoController::reset() {
  command(tr("Resetting…"), tr("The device could not be reset."),
          [](HapticDevice& device) { device.reset(); });
}

void ServoController::setClutched(bool isClutched) {
  // Without a device there is nothing to reposition.
  if (isRunning() && status_.hand == ui::Hand::Device) {
    loop_.setClutched(isClutched);
    status_.isClutched = isClutched;
  }
  emit statusChanged(status_);
}

void ServoController::setRate(const RateSettings& settings) {
  rate_ = settings;
  if (auto* driven = dynamic_cast<RateDriven*>(device_.get())) driven->setRate(settings);
}

bool ServoController::takeDeviceState() {
  // A command that is under way stays on show until it is done.
  if (status_.hand != ui::Hand::Device || !isRunning() || status_.isBusy) return false;
  const DeviceState state = device_->state();
  const DeviceInfo info = device_->info();
  const bool isArmable = info.forceAxes > 0;
  const bool isArmed = isArmable && state == DeviceState::Armed;
  const QString text = deviceText(state, isArmable, QString::fromStdString(device_->stateNote())) +
                       missingAxesText(state, info);
  if (text == status_.deviceState && isArmed == status_.isArmed && isArmable == status_.isArmable)
    return false;
  status_.deviceState = text;
  status_.isUncalibrated = state == DeviceState::Uncalibrated;
  status_.isFaulted = state == DeviceState::Fault;
  status_.isArmed = isArmed;
  status_.isArmable = isArmable;
  return true;
}

void ServoController::followSession() {
  if (isCommitting_) return;
  if (isOpened_) return takeOpened();
  if (!isRunning()) return;
  const Scene& scene = session_.scene();
  // The part or group in hand is gone or is no longer to be moved: there is no pose to keep.
  const bool isSame = scene.movingPart() == moving_ && scene.movingGroup() == movingGroup_;
  if (!isSame || session_.sceneSerial() != sceneSerial_) {
    halt();
    return;
  }
  if (!isReadyToFeel(scene)) {
    emit hierarchiesNeeded();
    return;
  }
  try {
    takeScene();
  } catch (...) {
    halt();
    fail(tr("The servo was stopped."), std::current_exception());
  }
}

void ServoController::takeScene() {
  const Scene& scene = session_.scene();
  // These hands give poses of the scene, which may be where only the other mode lets the part go. A device gives
  // its own motion, for which the tick brings the handle back to the part.
  if (scene.haptics().mode != mode_ && status_.hand != ui::Hand::Device) return restartAtPart();
  loop_.setScene(servoScene());
  loop_.setParameters(parametersFor(scene, *device_));
  mode_ = scene.haptics().mode;
}

void ServoController::restartAtPart() {
  loop_.stop();
  loop_.pollSnapshot();
  const ServoSnapshot& last = loop_.snapshot();
  const RigidTransform part = last.tick > 0 && last.proxy.isFinite() ? last.proxy : startPose_;
  auto moved = startScene(part);
  DevicePtr hand = startedHand(*moved);
  runOn(std::move(hand), std::move(moved));
  emit handReturned(startPose_);
}

void ServoController::poll() {
  rows_.take();
  showNewest();
  if (!loop_.isRunning()) {
    putDownAfterEnd();
    return;
  }
  const bool isNew = takeDeviceState(), isMeasured = meter_.isDue();
  if (isMeasured) {
    meter_.measure(loop_, loopDevice_->counters(), status_);
    rows_.tell();
  }
  if (isNew || isMeasured) emit statusChanged(status_);
}

void ServoController::showNewest() {
  if (!loop_.pollSnapshot()) return;
  const ServoSnapshot& snapshot = loop_.snapshot();
  meter_.see(snapshot);
  emit snapshotArrived(snapshot);
}

void ServoController::putDownAfterEnd() {
  const bool isLost = status_.hand == ui::Hand::Device && device_->state() == DeviceState::Lost;
  const std::string name = device_->info().name, note = device_->stateNote();
  stop();
  if (!isLost) return;
  const DeviceError error(DeviceProblem::Gone, name, note, "plug it in again, choose it and feel again");
  fail(tr("The device was lost. The part stays where it was."), std::make_exception_ptr(error));
}

}  // namespace nearfit::desktop
