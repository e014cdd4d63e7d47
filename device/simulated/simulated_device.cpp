#include "device/simulated/simulated_device.h"

#include <utility>

#include "core/base/error.h"

namespace nearfit {

PathDevice::PathDevice(std::vector<RigidTransform> path, bool repeats)
    : path_(std::move(path)), repeats_(repeats) {
  if (path_.empty()) throw UsageError("path", "it has no poses", "give at least one");
}

DeviceInfo PathDevice::info() const {
  return {"Simulated hand on a path", 6, DeviceLimits{}};
}

void PathDevice::start(const RigidTransform&, const ProgressCallback&) {
  next_ = 0;
  lastWrench_ = Wrench{};
  state_.store(DeviceState::Armed, std::memory_order_relaxed);
}

void PathDevice::stop() noexcept {
  state_.store(DeviceState::Ready, std::memory_order_relaxed);
}

bool PathDevice::waitForHandle(Nanoseconds deadline) noexcept {
  waitUntil(deadline);
  return false;
}

bool PathDevice::readHandle(HandleInput& handle) noexcept {
  if (state() != DeviceState::Armed) return false;
  if (next_ == path_.size()) {
    if (!repeats_) {
      state_.store(DeviceState::Ready, std::memory_order_relaxed);
      return false;
    }
    next_ = 0;
  }
  handle = {.pose = path_[next_++]};
  return true;
}

void PathDevice::sendWrench(const Wrench& wrench) noexcept {
  lastWrench_ = wrench;
}

DeviceInfo ManualDevice::info() const {
  return {"Mouse and numbers", 0, DeviceLimits{}, 0.0, false};
}

void ManualDevice::start(const RigidTransform& worldFromPart, const ProgressCallback&) {
  pose_.publish(worldFromPart);
  state_.store(DeviceState::Armed, std::memory_order_relaxed);
}

void ManualDevice::stop() noexcept {
  state_.store(DeviceState::Ready, std::memory_order_relaxed);
}

bool ManualDevice::waitForHandle(Nanoseconds deadline) noexcept {
  waitUntil(deadline);
  return false;
}

bool ManualDevice::readHandle(HandleInput& handle) noexcept {
  if (state() != DeviceState::Armed) return false;
  pose_.update();
  handle = {.pose = pose_.front()};
  return true;
}

void ManualDevice::sendWrench(const Wrench&) noexcept {}

}  // namespace nearfit
