#pragma once

#include "core/haptics/device_limits.h"
#include "core/haptics/handle_input.h"
#include "core/haptics/wrench.h"

namespace nearfit {

/// Result of limitWrench().
struct LimitedWrench {
  Wrench wrench;
  bool isClamped = false;  ///< The force, the torque or both were scaled down.
};

/// Scales force and torque, each by itself, down to its limit; directions are kept. A limit that is NaN or
/// negative counts as zero. Real-time safe.
/// @param wrench  Finite.
LimitedWrench limitWrench(const Wrench& wrench, const DeviceLimits& limits) noexcept;

/// Result of WrenchConditioner::condition().
struct ConditionedWrench {
  Wrench wrench;           ///< To be sent: finite and within the device's limits.
  bool isClamped = false;  ///< The wanted force or torque exceeded the device's max.
  bool isSlewed = false;   ///< The slew limit applied: the wrench is still on its way.
  bool isFinite = true;    ///< If false, what was wanted was not finite, and `wrench` is zero.
};

/// The last stage before a device: ramp after engaging, fade with the age of the input, clamp and slew limit,
/// in this order. Starts disengaged. Real-time safe.
class WrenchConditioner {
 public:
  static constexpr double kRampTime = 0.2;      ///< From engaging to full strength [s].
  static constexpr double kRecoveryTime = 0.2;  ///< From zero to full once the input is fresh again [s].

  /// Starts the ramp again; a wrench being sent falls at the pace of the slew limit.
  void engage() noexcept;
  /// From now on the wanted wrench is zero: what is sent falls to zero at the pace of the slew limit (full
  /// force in 5 ms by default).
  void disengage() noexcept;
  bool isEngaged() const noexcept { return isEngaged_; }

  /// The wrench to send for a wanted one.
  /// @param wanted    In any frame that does not rotate between calls.
  /// @param inputAge  Age of the pose behind it [s]; negative counts as fresh, NaN as stale.
  /// @param period    Since the last call [s]; if not finite or <= 0, no time has passed and nothing changes,
  ///                  except that lowered limits apply.
  /// @param patience  How forces fade with that age; NaN is no patience at all.
  /// If a wanted number is not finite, the result is zero at once and the ramp starts again, as after
  /// engaging. On a fault the caller need do nothing more, and later calls are not affected.
  ConditionedWrench condition(const Wrench& wanted, double inputAge, double period,
                              const DeviceLimits& limits, const PoseFade& patience = {}) noexcept;

 private:
  double nextGain(double inputAge, double period, const PoseFade& patience) noexcept;

  bool isEngaged_ = false;
  double ramp_ = 0.0;       ///< Part of kRampTime that has passed.
  double freshness_ = 1.0;  ///< Falls with the input's age, recovers in time.
  Wrench last_;             ///< The last wrench sent.
};

}  // namespace nearfit
