#include "device/common/force_arm_device.h"

#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/math/finite.h"
#include "device/interface/device_error.h"

namespace nearfit {
namespace {

/// A working device takes a command at once.
constexpr UsbLink::Timeout kCommandTimeout{100};
/// Holds the part while the hand repositions the device.
constexpr std::uint8_t kClutchButton = 1;

}  // namespace

ForceArmDevice::ForceArmDevice(UsbDescription device, std::string kind, const DeviceLimits& limits,
                               const SafetyLimits& safety, int sensedAxes)
    : device_(std::move(device)),
      kind_(std::move(kind)),
      limits_(limits),
      safety_(safety),
      sensedAxes_(sensedAxes) {}

std::string ForceArmDevice::name() const {
  return fmt::format("{} ({} at {})", product_.empty() ? kind_ : product_, device_.id(), device_.node());
}

DeviceInfo ForceArmDevice::info() const {
  return {name(), 3, limits_, opened_.reportPeriod, true, sensedAxes_};
}

void ForceArmDevice::start(const RigidTransform&, const ProgressCallback& progress) {
  stop();
  stream_.supervisor().beginOpening();
  try {
    opened_ = open(link_, progress);
    product_ = link_->strings().product;
    stream_.begin(opened_.rest);
    SafetyLimits limits = safety_;
    limits.keepPace(opened_.reportPeriod);
    stream_.supervisor().opened(limits, opened_.isCalibrated);
    link_->stream(opened_.streams, *this);
    // The device only answers commands: the first one starts it.
    link_->send(command(glm::dvec3(0.0), opened_.rest));
  } catch (...) {
    link_.reset();
    stream_.supervisor().closed(stateAfterFailure());
    throw;
  }
}

void ForceArmDevice::stop() noexcept {
  if (!link_) return;
  disarm();
  restMotors();
  const bool isLost = state() == DeviceState::Lost;
  link_.reset();
  stream_.supervisor().closed(isLost ? DeviceState::Lost : DeviceState::Present);
}

/// Streaming may end before the last command is sent, and motors keep pushing as last told until the device's
/// watchdog, if it has one, stops them.
void ForceArmDevice::restMotors() noexcept {
  link_->stop();
  if (state() == DeviceState::Lost) return;
  try {
    link_->write(opened_.streams.out, command(glm::dvec3(0.0), opened_.rest), kCommandTimeout);
  } catch (const Error&) {
    // The device is gone or hangs: nothing more can be done from here.
  }
}

bool ForceArmDevice::readHandle(HandleInput& handle) noexcept {
  if (!stream_.update()) return false;
  const ArmSample& sample = stream_.report();
  handle.pose = sample.pose;
  handle.age = stream_.age();
  handle.patience = stream_.supervisor().patience();
  // An uncalibrated pose means nothing: the part stays.
  handle.isClutched = (sample.buttons & kClutchButton) != 0 || state() == DeviceState::Uncalibrated;
  handle.hasOwnFrame = true;
  handle.isTorqueFelt = sensedAxes_ == 3;
  handle.buttons = sample.buttons;
  handle.isArmed = stream_.supervisor().check({handle.age, glm::length(sample.velocity), false});
  return true;
}

void ForceArmDevice::sendWrench(const Wrench& wrench) noexcept {
  const ArmSample& sample = stream_.report();
  const Wrench guarded = stream_.supervisor().guarded(wrench, sample.velocity, limits_.maxForce);
  // The servo sends only finite wrenches; a motor must never see anything else.
  const glm::dvec3 force = isFinite(guarded.force) ? guarded.force : glm::dvec3(0.0);
  link_->send(command(force, sample));
}

}  // namespace nearfit
