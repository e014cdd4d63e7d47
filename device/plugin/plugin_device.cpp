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

constexpr std::uint32_t kClutchButton = 1;
/// Same as OpenHap: allows for rounding and imprecise arithmetic.
constexpr double kQuaternionSlack = 1e-2;

glm::dvec3 vectorOf(const double (&v)[3]) noexcept {
  return {v[0], v[1], v[2]};
}

bool isSound(const NearfitDevicePose& pose) noexcept {
  double sum = pose.age, lengthSquared = 0.0;
  for (int i = 0; i < 3; ++i)
    sum += std::abs(pose.position[i]) + std::abs(pose.velocity[i]);
  for (const double part : pose.rotation)
    lengthSquared += part * part;
  return std::isfinite(sum) && std::abs(std::sqrt(lengthSquared) - 1.0) <= kQuaternionSlack;
}

/// A device of a plug-in. Nothing that the plug-in returns is trusted.
class PluginDevice final : public HapticDevice {
 public:
  PluginDevice(std::shared_ptr<const DevicePlugin> plugin, int index,
               const NearfitDeviceDescription& description)
      : plugin_(std::move(plugin)), index_(index), description_(description) {}
  ~PluginDevice() override { stop(); }

  DeviceInfo info() const override {
    DeviceInfo info{
        std::string(description_.name) + " (" + plugin_->name() + ")", description_.force_axes, {}};
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
    switch (state()) {
      case DeviceState::Fault:
        return faultReason(supervisor_.fault());
      case DeviceState::Lost:
        return "it no longer answers";
      case DeviceState::Uncalibrated:
        return "it is not calibrated";
      default:
        return {};
    }
  }

  /// The device is polled, so every answer counts as a report.
  ReportCounters counters() const noexcept override {
    return {poses_.load(std::memory_order_relaxed), rejected_.load(std::memory_order_relaxed)};
  }

  void start(const RigidTransform&, const ProgressCallback& = {}) override {
    stop();
    supervisor_.beginOpening();
    std::array<char, 512> error{};
    device_ = plugin_->functions().open(index_, error.data(), error.size());
    if (device_ == nullptr) {
      supervisor_.closed(DeviceState::Present);
      throw DeviceError(
          DeviceProblem::Failed, description_.name,
          "it could not be opened: " + std::string(error.data(), ::strnlen(error.data(), error.size())),
          "close other programs that use it, or plug it in again");
    }
    SafetyLimits limits;
    limits.hasDeadMan = description_.has_dead_man != 0;
    limits.keepBelow(description_.max_speed);
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
    plugin_->functions().close(device_);
    device_ = nullptr;
    supervisor_.closed(isLost ? DeviceState::Lost : DeviceState::Present);
  }
  void arm() override {
    supervisor_.arm(description_.name);
    std::array<char, 512> error{};
    if (plugin_->functions().set_forces(device_, 1, error.data(), error.size()) == 0) return;
    supervisor_.disarm();
    throw DeviceError(
        DeviceProblem::Failed, description_.name,
        "it cannot be armed: " + std::string(error.data(), ::strnlen(error.data(), error.size())));
  }
  /// No-op: the maker's software calibrates.
  void calibrate() override {}
  void reset() override { supervisor_.reset(); }
  void disarm() noexcept override {
    supervisor_.disarm();
    std::array<char, 512> ignored{};
    if (device_ != nullptr) plugin_->functions().set_forces(device_, 0, ignored.data(), ignored.size());
  }

  /// The device is polled, so the servo sets the pace.
  bool waitForHandle(Nanoseconds deadline) noexcept override {
    waitUntil(deadline);
    return false;
  }
  bool readHandle(HandleInput& handle) noexcept override {
    if (device_ == nullptr || state() == DeviceState::Lost) return false;
    NearfitDevicePose pose = last_;
    if (plugin_->functions().read(device_, &pose) != 0) {
      supervisor_.lost();
      return false;
    }
    if (isSound(pose)) {
      last_ = pose;
      poses_.fetch_add(1, std::memory_order_relaxed);
    } else {
      rejected_.fetch_add(1, std::memory_order_relaxed);
      supervisor_.stop(DeviceFault::Garbage);
    }
    if ((pose.flags & NEARFIT_DEVICE_FAULT) != 0) supervisor_.stop(DeviceFault::Reported);
    if ((pose.flags & NEARFIT_DEVICE_CALIBRATED) != 0) supervisor_.calibrated();
    const double(&q)[4] = last_.rotation;
    handle = {};
    handle.pose = RigidTransform{{q[0], q[1], q[2], q[3]}, vectorOf(last_.position)}.normalized();
    handle.age = std::max(last_.age, 0.0);
    handle.patience = supervisor_.patience();
    handle.isClutched = (last_.buttons & kClutchButton) != 0;
    handle.hasOwnFrame = true;
    handle.buttons = last_.buttons;
    handle.isArmed = supervisor_.check({handle.age, glm::length(vectorOf(last_.velocity)),
                                        (last_.flags & NEARFIT_DEVICE_DEAD_MAN_HELD) != 0}) ||
                     description_.force_axes == 0;
    return true;
  }
  void sendWrench(const Wrench& wrench) noexcept override {
    if (device_ == nullptr || description_.force_axes == 0) return;
    const Wrench guarded = supervisor_.guarded(wrench, vectorOf(last_.velocity), description_.max_force);
    const double force[3] = {guarded.force.x, guarded.force.y, guarded.force.z};
    const double torque[3] = {guarded.torque.x, guarded.torque.y, guarded.torque.z};
    if (plugin_->functions().write(device_, force, torque) != 0) supervisor_.lost();
  }

 private:
  const std::shared_ptr<const DevicePlugin> plugin_;
  const int index_;
  const NearfitDeviceDescription description_;
  NearfitDevice* device_ = nullptr;
  DeviceSupervisor supervisor_;
  NearfitDevicePose last_{};
  std::atomic<std::uint64_t> poses_{0}, rejected_{0};
};

}  // namespace

std::unique_ptr<HapticDevice> makePluginDevice(std::shared_ptr<const DevicePlugin> plugin, int index,
                                               const NearfitDeviceDescription& description) {
  return std::make_unique<PluginDevice>(std::move(plugin), index, description);
}

}  // namespace nearfit
