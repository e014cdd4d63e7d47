#include "device/interface/device_supervisor.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "device/interface/device_error.h"

namespace nearfit {

const char* faultReason(DeviceFault fault) noexcept {
  switch (fault) {
    case DeviceFault::None:
      return "";
    case DeviceFault::Silent:
      return "its poses stopped coming";
    case DeviceFault::TooFast:
      return "its handle moved too fast";
    case DeviceFault::Reported:
      return "it reported a fault";
    case DeviceFault::Garbage:
      return "its reports cannot be read";
    case DeviceFault::OutOfReach:
      return "its joints are outside their range, so its calibration is wrong";
    case DeviceFault::Hot:
      return "its motors are too warm: let them cool down";
    case DeviceFault::Overloaded:
      return "it was asked for more force than it can give";
    case DeviceFault::BrokenLink:
      return "its connection is disturbed: plug it straight into the computer";
    case DeviceFault::SwitchedOff:
      return "its forces were turned off at the device";
    case DeviceFault::PoseUnknown:
      return "it no longer knows where its handle is: calibrate it";
  }
  return "";
}

DeviceState stateAfterFailure() noexcept {
  try {
    throw;
  } catch (const DeviceError& error) {
    return error.cause() == DeviceProblem::Gone ? DeviceState::Absent : DeviceState::Present;
  } catch (...) {
    return DeviceState::Present;
  }
}

bool DeviceSupervisor::change(DeviceState from, DeviceState to) noexcept {
  return state_.compare_exchange_strong(from, to, std::memory_order_acq_rel);
}

void DeviceSupervisor::beginOpening() noexcept {
  fault_.store(DeviceFault::None, std::memory_order_release);
  state_.store(DeviceState::Opening, std::memory_order_release);
}

void DeviceSupervisor::opened(const SafetyLimits& limits, bool isCalibrated) noexcept {
  limits_ = limits;
  areForcesOut_ = false;
  isCalibrated_.store(isCalibrated, std::memory_order_release);
  // Fails if the device was lost meanwhile, and should.
  change(DeviceState::Opening, isCalibrated ? DeviceState::Ready : DeviceState::Uncalibrated);
}

void DeviceSupervisor::closed(DeviceState state) noexcept {
  state_.store(state, std::memory_order_release);
}

void DeviceSupervisor::arm(const std::string& device) {
  if (change(DeviceState::Ready, DeviceState::Armed)) return;
  switch (state()) {
    case DeviceState::Armed:
      return;
    case DeviceState::Uncalibrated:
      throw DeviceError(DeviceProblem::NotAnswering, device, "it is not calibrated, so it cannot be armed",
                        "move its handle as its manual says, or put it in its rest");
    case DeviceState::Fault:
      throw DeviceError(DeviceProblem::Failed, device, std::string("it was stopped: ") + faultReason(fault()),
                        "let go of the handle, reset it, then arm it");
    case DeviceState::Lost:
      throw DeviceError(DeviceProblem::Gone, device, "it was unplugged", "plug it in again and open it");
    default:
      throw DeviceError(DeviceProblem::Failed, device, "it is not open, so it cannot be armed",
                        "open it first");
  }
}

void DeviceSupervisor::requireCalibratable(const std::string& device) const {
  switch (state()) {
    case DeviceState::Ready:
    case DeviceState::Uncalibrated:
      return;
    case DeviceState::Armed:
      throw DeviceError(DeviceProblem::Failed, device,
                        "it is armed, and calibration would make its pose jump",
                        "disarm it, then calibrate it");
    case DeviceState::Lost:
      throw DeviceError(DeviceProblem::Gone, device, "it was unplugged", "plug it in again and open it");
    default:
      throw DeviceError(DeviceProblem::Failed, device, "it is not open, or was stopped",
                        "open it again, then calibrate it");
  }
}

void DeviceSupervisor::reset() noexcept {
  if (state() != DeviceState::Fault) return;
  fault_.store(DeviceFault::None, std::memory_order_release);
  change(DeviceState::Fault,
         isCalibrated_.load(std::memory_order_acquire) ? DeviceState::Ready : DeviceState::Uncalibrated);
}

void DeviceSupervisor::disarm() noexcept {
  change(DeviceState::Armed, DeviceState::Ready);
}

void DeviceSupervisor::calibrated() noexcept {
  isCalibrated_.store(true, std::memory_order_release);
  change(DeviceState::Uncalibrated, DeviceState::Ready);
}

void DeviceSupervisor::uncalibrated() noexcept {
  isCalibrated_.store(false, std::memory_order_release);
  change(DeviceState::Ready, DeviceState::Uncalibrated);
  if (state() == DeviceState::Armed) stop(DeviceFault::PoseUnknown);
}

void DeviceSupervisor::lost() noexcept {
  state_.store(DeviceState::Lost, std::memory_order_release);
}

void DeviceSupervisor::stop(DeviceFault fault) noexcept {
  for (const DeviceState from : {DeviceState::Armed, DeviceState::Ready, DeviceState::Uncalibrated}) {
    if (state() != from) continue;
    DeviceFault none = DeviceFault::None;
    fault_.compare_exchange_strong(none, fault, std::memory_order_acq_rel);
    if (fault == DeviceFault::OutOfReach) isCalibrated_.store(false, std::memory_order_release);
    change(from, DeviceState::Fault);
  }
}

bool DeviceSupervisor::check(const Sample& sample) noexcept {
  // Negated comparisons, so that NaN stops the device too.
  if (state() == DeviceState::Armed) {
    if (!(sample.age <= limits_.patience.silence))
      stop(DeviceFault::Silent);
    else if (!(sample.speed <= limits_.faultSpeed))
      stop(DeviceFault::TooFast);
  }
  areForcesOut_ = state() == DeviceState::Armed && (sample.isDeadManHeld || !limits_.hasDeadMan);
  return areForcesOut_;
}

Wrench DeviceSupervisor::guarded(const Wrench& wrench, const glm::dvec3& velocity,
                                 double maxForce) const noexcept {
  // Asks again: the device may have been disarmed or lost since check().
  if (!areForcesOut_ || state() != DeviceState::Armed) return {};
  const double speed = glm::length(velocity);
  if (!(speed > limits_.brakeSpeed)) return wrench;
  Wrench braked = wrench;
  braked.force -= limits_.brakeDamping * (speed - limits_.brakeSpeed) / speed * velocity;
  const double force = glm::length(braked.force);
  if (!std::isfinite(force)) return {};
  if (force > maxForce) braked.force *= maxForce / force;
  return braked;
}

}  // namespace nearfit
