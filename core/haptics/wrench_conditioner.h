#pragma once

#include "core/haptics/device_limits.h"
#include "core/haptics/handle_input.h"
#include "core/haptics/wrench.h"

namespace nearfit {

struct LimitedWrench {
  Wrench wrench;
  bool isClamped = false;  ///< The force, the torque or both were scaled down.
};

/// Scales force and torque, each by itself, down to its limit; directions stay as they are.
/// @param wrench  Finite.  A limit that is NaN or negative counts as zero.
/// Real-time safe.
LimitedWrench limitWrench(const Wrench& wrench, const DeviceLimits& limits) noexcept;

struct ConditionedWrench {
  Wrench wrench;           ///< To be sent: finite and within the device's limits.
  bool isClamped = false;  ///< The wanted force or torque was more than the device bears.
  bool isSlewed = false;   ///< It changes faster than the device may, and is still on its way.
  bool isFinite = true;    ///< Of what was wanted; if not, `wrench` is zero.
};

/// The last stage before a device: in this order ramp-in after engaging, decay with the age of the input,
/// clamp, slew limit. Starts disengaged.
class WrenchConditioner {
 public:
  static constexpr double kRampTime = 0.2;      ///< From engaging to full strength [s].
  static constexpr double kRecoveryTime = 0.2;  ///< From nothing to full once the input is fresh again [s].

  /// Begins the ramp anew; a wrench that is being sent is left at the pace of the slew limit.
  void engage() noexcept;
  /// From now on nothing is wanted: what is sent falls to zero at the pace of the slew limit (full force in
  /// 5 ms by default).
  void disengage() noexcept;
  bool isEngaged() const noexcept { return isEngaged_; }

  /// @param wanted    In any frame that does not turn between calls.
  /// @param inputAge  Of the pose behind it [s]; negative is fresh, NaN stale.
  /// @param period    Since the call before [s]; not finite or <= 0: no time has passed, and nothing changes
  ///                  but that limits which have become lower are kept.
  /// @param patience  With that age; what is not finite is no patience at all.
  /// A wanted number that is not finite gives zero at once, and the ramp begins anew, as after engaging: the
  /// caller's path for faults need do nothing more, and later calls are not affected. Real-time safe.
  ConditionedWrench condition(const Wrench& wanted, double inputAge, double period,
                              const DeviceLimits& limits, const PosePatience& patience = {}) noexcept;

 private:
  double nextGain(double inputAge, double period, const PosePatience& patience) noexcept;

  bool isEngaged_ = false;
  double ramp_ = 0.0;       ///< Part of kRampTime that has passed.
  double freshness_ = 1.0;  ///< Falls with the input's age, rises in time.
  Wrench last_;             ///< As sent.
};

}  // namespace nearfit
