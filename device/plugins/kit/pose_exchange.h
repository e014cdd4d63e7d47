#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "core/realtime/triple_buffer.h"
#include "device/plugin/nearfit_device.h"
#include "device/thread/monotonic_clock.h"

namespace nearfit::plugin {

/// Force [N] and torque [N m] in the device's frame, as Nearfit has it.
struct PluginWrench {
  std::array<double, 3> force{}, torque{};
};

/// Carries poses from the maker's thread to the servo and wrenches back, without a lock, and holds what ends forces:
/// a fault, a loss, Nearfit's silence, Nearfit's word.
class PoseExchange {
 public:
  PoseExchange() noexcept {
    TimedPose none{};
    none.pose.rotation[0] = 1.0;
    none.arrived = monotonicNow();
    poses_.publish(none);
    poses_.update();
  }

  // Maker's thread.

  /// Passes a pose on and wakes the servo. Its age and fault are filled in by read().
  void publish(const NearfitDevicePose& pose, Nanoseconds arrived) noexcept {
    newWrench_.wait(0);  // An answer to the pose before is none to this one.
    poses_.publish(TimedPose{pose, arrived});
    newPose_.ring();
  }
  /// Sleeps until the servo has answered the last pose, or until `deadline`. Returns true if it has.
  bool waitForWrench(Nanoseconds deadline) noexcept { return newWrench_.wait(deadline); }
  /// Returns what the motors are to do now: zero while forces are off, after a fault, and kMaxSilence after the last
  /// answer.
  PluginWrench wrenchNow() noexcept {
    wrenches_.update();
    const TimedWrench& newest = wrenches_.front();
    const bool isFresh = monotonicNow() - newest.written <= kMaxSilence;
    return areForcesOn() && isFresh ? newest.wrench : PluginWrench{};
  }
  /// Stops forces until clearFault(). The first fault is kept.
  void stop(std::uint32_t fault) noexcept {
    std::uint32_t none = NEARFIT_FAULT_NONE;
    fault_.compare_exchange_strong(none, fault, std::memory_order_acq_rel);
  }
  /// Ends all: read() and write() fail from now on.
  void lose() noexcept {
    isLost_.store(true, std::memory_order_release);
    newPose_.ring();
  }

  // Any thread.

  bool areForcesOn() const noexcept {
    return areForcesOn_.load(std::memory_order_acquire) && fault() == NEARFIT_FAULT_NONE && !isLost();
  }
  bool isLost() const noexcept { return isLost_.load(std::memory_order_acquire); }
  std::uint32_t fault() const noexcept { return fault_.load(std::memory_order_acquire); }

  // Controlling thread.

  void setForces(bool areOn) noexcept { areForcesOn_.store(areOn, std::memory_order_release); }
  /// Forces stay off, whatever they were before the fault.
  void clearFault() noexcept {
    setForces(false);
    fault_.store(NEARFIT_FAULT_NONE, std::memory_order_release);
  }

  // Servo thread; real-time safe.

  bool wait(Nanoseconds deadline) noexcept { return newPose_.wait(deadline); }
  std::int32_t read(NearfitDevicePose& pose) noexcept {
    if (isLost()) return -1;
    poses_.update();
    pose = poses_.front().pose;
    pose.age = toSeconds(monotonicNow() - poses_.front().arrived);
    pose.fault = fault();
    return 0;
  }
  std::int32_t write(const double* force, const double* torque) noexcept {
    if (isLost()) return -1;
    TimedWrench& next = wrenches_.back();
    for (std::size_t i = 0; i < 3; ++i) {
      next.wrench.force[i] = force[i];
      next.wrench.torque[i] = torque[i];
    }
    next.written = monotonicNow();
    wrenches_.publish();
    newWrench_.ring();
    return 0;
  }

  /// So long a wrench holds: what nearfit_device.h demands.
  static constexpr Nanoseconds kMaxSilence = 20'000'000;

 private:
  struct TimedPose {
    NearfitDevicePose pose;
    Nanoseconds arrived;
  };
  struct TimedWrench {
    PluginWrench wrench;
    Nanoseconds written = 0;
  };

  TripleBuffer<TimedPose> poses_;
  TripleBuffer<TimedWrench> wrenches_;
  WakeSignal newPose_, newWrench_;
  std::atomic<bool> areForcesOn_{false}, isLost_{false};
  std::atomic<std::uint32_t> fault_{NEARFIT_FAULT_NONE};
};

}  // namespace nearfit::plugin
