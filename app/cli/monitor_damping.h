#pragma once

#include "core/haptics/handle_input.h"
#include "core/haptics/wrench.h"
#include "device/servo/monotonic_clock.h"
#include "device/velocity_filter.h"

namespace nearfit::cli {

/// A weak resistance to motion, so that a monitor has a force to show: as if the handle moved in syrup.
///
/// It fades in after each time that the device begins to push. It only ever takes energy out as long as the
/// device measures right; should it not (a joint that counts the wrong way), what it adds is kMost at most,
/// and nothing at all beyond kNoneFrom.
class MonitorDamping {
 public:
  static constexpr double kDamping = 2.0;  ///< Of the order of what devices have themselves [N s/m].
  static constexpr double kMost = 0.5;     ///< As --test pushes at most [N].
  /// A hand that looks at a monitor is slower; from the first to the second the force fades [m/s].
  static constexpr double kAllUpTo = 0.4, kNoneFrom = 0.6;
  static constexpr double kFadeIn = 1.0;  ///< [s]
  /// Older poses tell nothing of the speed now [s].
  static constexpr double kFresh = 5e-3;

  /// What to send, in the device's frame; none when the device does not push.
  Wrench step(const HandleInput& handle, bool isArmed, Nanoseconds now) noexcept;

 private:
  VelocityFilter velocity_;
  Nanoseconds pushingSince_ = 0;
};

}  // namespace nearfit::cli
