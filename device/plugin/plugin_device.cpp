#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>

#include <glm/geometric.hpp>

#include "device/interface/device_error.h"
#include "device/interface/device_supervisor.h"
#include "device/plugin/device_plugin.h"
#include "device/thread/monotonic_clock.h"

namespace nearfit {
namespace {

constexpr std::uint32_t kPluginClutchButton = 1;
/// Same as OpenHap: allows for rounding and imprecise arithmetic.
constexpr double kQuaternionSlack = 1e-2;

using PluginText = std::array<char, 512>;

std::string wordsOf(const PluginText& text) {
  return {text.data(), ::strnlen(text.data(), text.size())};
}

glm::dvec3 vectorOf(const double (&v)[3]) noexcept {
  return {v[0], v[1], v[2]};
}

bool isSound(const NearfitDevicePose& pose) noexcept {
  double sum = pose.age, lengthSquared = 0.0;
  for (int i = 0; i < 3; ++i)
    sum += std::abs(pose.position[i]) + std::abs(pose.velocity[i]);
  for (const double part : pose.rotation)
    lengthSquared += part * part;
  if ((pose.flags & NEARFIT_DEVICE_HAS_GRIP) != 0) sum += std::abs(pose.grip);
  return std::isfinite(sum) && std::abs(std::sqrt(lengthSquared) - 1.0) <= kQuaternionSlack;
}

DeviceFault faultFrom(std::uint32_t fault) noexcept {
  switch (fault) {
    case NEARFIT_FAULT_NONE:
      return DeviceFault::None;
    case NEARFIT_FAULT_HOT:
      return DeviceFault::Hot;
    case NEARFIT_FAULT_OVERLOAD:
      return DeviceFault::Overloaded;
    case NEARFIT_FAULT_SPEED:
      return DeviceFault::TooFast;
    case NEARFIT_FAULT_LINK:
      return DeviceFault::BrokenLink;
    case NEARFIT_FAULT_SWITCHED_OFF:
      return DeviceFault::SwitchedOff;
    default:
      return DeviceFault::Reported;
  }
}

/// A device of a plug-in. Nothing that the plug-in returns is trusted.
class PluginDevice final : public HapticDevice {
 public:
  PluginDevice(std::shared_ptr<const DevicePlugin> plugin, int index,
               const NearfitDeviceDescription& description, const SafetyLimits& safety)
      : plugin_(std::move(plugin)), index_(index), description_(description), safety_(safety) {}
  ~PluginDevice() override { stop(); }

  DeviceInfo info() const override {
    DeviceInfo info{
        std::string(description_.name) + " (" + plugin_->name() + ")", description_.force_axes, {}};
    info.sensedAxes = description_.sensed_axes;
    if (isPacing()) info.reportPeriod = 1.0 / description_.rate;
    SafetyLimits safety = safety_;
    safety.keepBelow(description_.max_speed);
    info.maxSpeed = safety.faultSpeed;
    DeviceLimits& limits = info.limits;
    if (description_.force_axes == 0) return info;
    limits.maxForce = description_.max_force;
    limits.maxTorque = description_.force_axes == 6 ? description_.max_torque : 0.0;
    limitSlewByMax(limits);
    limits.damping = description_.damping;
    limits.rotationalDamping = description_.rotational_damping;
    limits.leastMass = std::max(limits.leastMass, description_.mass);
    limits.leastInertia = std::max(limits.leastInertia, description_.inertia);
    return info;
  }
  DeviceState state() const noexcept override { return supervisor_.state(); }
  std::string stateNote() const override {
    const std::string words = itsWords();
    switch (state()) {
      case DeviceState::Fault: {
        const std::string reason = faultReason(supervisor_.fault());
        return words.empty() ? reason : reason + " (" + words + ")";
      }
      case DeviceState::Lost:
        return words.empty() ? "it no longer answers" : words;
      case DeviceState::Uncalibrated:
        return words.empty() ? "it is not calibrated" : words;
      default:
        return {};
    }
  }

  /// Of a device that is polled, every answer counts as a report; else every new pose.
  ReportCounters counters() const noexcept override {
    return {poses_.load(std::memory_order_relaxed), rejected_.load(std::memory_order_relaxed)};
  }

  void start(const RigidTransform&, const ProgressCallback& = {}) override {
    stop();
    supervisor_.beginOpening();
    PluginText error{};
    device_ = functions().open(index_, error.data(), error.size());
    if (device_ == nullptr) {
      supervisor_.closed(DeviceState::Present);
      throw DeviceError(DeviceProblem::Failed, description_.name, "it could not be opened: " + wordsOf(error),
                        "close other programs that use it, or plug it in again");
    }
    takeDetails();
    SafetyLimits limits = safety_;
    limits.hasDeadMan = description_.has_dead_man != 0;
    limits.keepBelow(description_.max_speed);
    if (isPacing()) limits.keepPace(1.0 / description_.rate);
    supervisor_.opened(limits, false);
    last_ = {};
    last_.rotation[0] = 1.0;
    // Reads the calibration flag.
    HandleInput ignored;
    readHandle(ignored);
  }
  void stop() noexcept override {
    if (device_ == nullptr) return;
    const bool isLost = state() == DeviceState::Lost;
    disarm();
    functions().close(device_);
    device_ = nullptr;
    supervisor_.closed(isLost ? DeviceState::Lost : DeviceState::Present);
  }
  void arm() override {
    supervisor_.arm(description_.name);
    PluginText error{};
    if (functions().set_forces(device_, 1, error.data(), error.size()) == 0) return;
    supervisor_.disarm();
    throw DeviceError(DeviceProblem::Failed, description_.name, "it cannot be armed: " + wordsOf(error));
  }
  /// No-op for a device whose maker's software calibrates it.
  void calibrate() override {
    if (functions().calibrate == nullptr) return;
    supervisor_.requireCalibratable(description_.name);
    PluginText error{};
    if (functions().calibrate(device_, error.data(), error.size()) == 0) return;
    throw DeviceError(DeviceProblem::Failed, description_.name,
                      "it could not be calibrated: " + wordsOf(error));
  }
  void reset() override {
    // The plug-in turns forces off as it resets: an armed device would push no more and look armed.
    if (state() != DeviceState::Fault) return;
    PluginText error{};
    if (device_ != nullptr && functions().reset != nullptr &&
        functions().reset(device_, error.data(), error.size()) != 0) {
      throw DeviceError(DeviceProblem::Failed, description_.name, "it cannot be reset: " + wordsOf(error));
    }
    supervisor_.reset();
  }
  void disarm() noexcept override {
    supervisor_.disarm();
    PluginText ignored{};
    if (device_ != nullptr) functions().set_forces(device_, 0, ignored.data(), ignored.size());
  }

  bool waitForHandle(Nanoseconds deadline) noexcept override {
    if (isPacing() && device_ != nullptr && state() != DeviceState::Lost) {
      isNew_ = functions().wait(device_, deadline) == 1;
      return isNew_;
    }
    waitUntil(deadline);
    return false;
  }
  bool readHandle(HandleInput& handle) noexcept override {
    if (device_ == nullptr || state() == DeviceState::Lost) return false;
    NearfitDevicePose pose = last_;
    if (functions().read(device_, &pose) != 0) {
      supervisor_.lost();
      return false;
    }
    take(pose);
    const double(&q)[4] = last_.rotation;
    handle = {};
    handle.pose = RigidTransform{{q[0], q[1], q[2], q[3]}, vectorOf(last_.position)}.normalized();
    handle.age = std::max(last_.age, 0.0);
    handle.patience = supervisor_.patience();
    // An uncalibrated pose means nothing, and calibration makes it jump: the part stays.
    handle.isClutched =
        (last_.buttons & kPluginClutchButton) != 0 || supervisor_.state() == DeviceState::Uncalibrated;
    handle.isTorqueFelt = description_.force_axes != 3 || description_.sensed_axes == 3;
    handle.hasOwnFrame = true;
    handle.buttons = last_.buttons;
    if ((last_.flags & NEARFIT_DEVICE_HAS_GRIP) != 0) handle.grip = last_.grip;
    handle.isArmed = supervisor_.check({handle.age, glm::length(vectorOf(last_.velocity)),
                                        (last_.flags & NEARFIT_DEVICE_DEAD_MAN_HELD) != 0}) ||
                     description_.force_axes == 0;
    return true;
  }
  void sendWrench(const Wrench& wrench) noexcept override {
    if (device_ == nullptr || description_.force_axes == 0) return;
    const Wrench sent = supervisor_.guarded(wrench, vectorOf(last_.velocity), description_.max_force);
    const double force[3] = {sent.force.x, sent.force.y, sent.force.z};
    const bool hasTorque = description_.force_axes == 6;
    const double torque[3] = {hasTorque ? sent.torque.x : 0.0, hasTorque ? sent.torque.y : 0.0,
                              hasTorque ? sent.torque.z : 0.0};
    if (functions().write(device_, force, torque) != 0) supervisor_.lost();
  }

 private:
  const NearfitDevicePlugin& functions() const noexcept { return plugin_->functions(); }
  bool isPacing() const noexcept { return description_.rate > 0.0 && functions().wait != nullptr; }
  std::string itsWords() const {
    PluginText text{};
    if (device_ != nullptr && functions().note != nullptr)
      functions().note(device_, text.data(), text.size());
    return wordsOf(text);
  }
  void takeDetails() {
    NearfitDeviceDescription details{};
    const std::string problem =
        functions().details(device_, &details) == 0 ? descriptionProblem(details) : "the plug-in gives none";
    if (problem.empty()) {
      description_ = details;
      return;
    }
    functions().close(device_);
    device_ = nullptr;
    supervisor_.closed(DeviceState::Present);
    throw DeviceError(DeviceProblem::Unsupported, description_.name,
                      "its description is not valid: " + problem,
                      "ask the plug-in's maker for a working version");
  }
  void take(const NearfitDevicePose& pose) noexcept {
    const bool hasSense = isSound(pose);
    if (hasSense) {
      last_ = pose;
      if (isNew_ || !isPacing()) poses_.fetch_add(1, std::memory_order_relaxed);
      isNew_ = false;
    } else {
      rejected_.fetch_add(1, std::memory_order_relaxed);
      supervisor_.stop(DeviceFault::Garbage);
    }
    if (pose.fault != NEARFIT_FAULT_NONE) supervisor_.stop(faultFrom(pose.fault));
    if (!hasSense) return;
    // After the fault, which may be why: the first reason is kept.
    if ((pose.flags & NEARFIT_DEVICE_CALIBRATED) != 0)
      supervisor_.calibrated();
    else
      supervisor_.uncalibrated();
  }

  std::shared_ptr<const DevicePlugin> plugin_;
  int index_;
  NearfitDeviceDescription description_;
  const SafetyLimits safety_;
  NearfitDevice* device_ = nullptr;
  DeviceSupervisor supervisor_;
  NearfitDevicePose last_{};
  bool isNew_ = false;  ///< Servo thread's: the last wait brought a pose that is not read yet.
  std::atomic<std::uint64_t> poses_{0}, rejected_{0};
};

}  // namespace

std::unique_ptr<HapticDevice> makePluginDevice(std::shared_ptr<const DevicePlugin> plugin, int index,
                                               const NearfitDeviceDescription& description,
                                               const SafetyLimits& safety) {
  return std::make_unique<PluginDevice>(std::move(plugin), index, description, safety);
}

}  // namespace nearfit
