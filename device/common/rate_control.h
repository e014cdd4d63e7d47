#pragma once

#include <array>

#include "core/haptics/rate_settings.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// A device that is driven by pushing it: its deflection sets a speed.
class RateDriven {
 public:
  virtual ~RateDriven() = default;
  /// Sets how deflection becomes speed. Controlling thread, at any time. Throws UsageError that names the
  /// value out of range.
  virtual void setRate(const RateSettings& settings) = 0;
};

/// Integrates deflections into a pose: the handle of a device that senses pushing, not position.
///
/// Such a device cannot stop the hand. The handle would run on while the part stands at a wall, and would
/// have to be driven all the way back before the part leaves it. So motion against the force on the handle
/// slows down as the force nears `leashForce`, and stops there; likewise for torque. Real-time safe.
class RateControl {
 public:
  /// @param leashForce   Stops motion against it [N]; 0 disables it.
  /// @param leashTorque  Stops turning against it [N m]; 0 disables it.
  RateControl(double leashForce, double leashTorque) noexcept
      : leashForce_(leashForce), leashTorque_(leashTorque) {}

  /// Continues from `pose`.
  void restart(const RigidTransform& pose) noexcept { pose_ = pose; }

  /// Advances by `time` [s], but by no more than kLongestStep. Returns the new pose.
  /// @param axes    Deflections along and about x, y, z, -1 to 1, in the frame of the pose's parent.
  /// @param wrench  Wrench on the handle, in the same frame [N, N m].
  const RigidTransform& step(const std::array<double, 6>& axes, const RateSettings& settings,
                             const Wrench& wrench, double time) noexcept;

  /// Keeps a pause of the servo from becoming a jump [s].
  static constexpr double kLongestStep = 0.02;

 private:
  double leashForce_, leashTorque_;
  RigidTransform pose_;
};

/// Shapes the deflection of one axis: 0 within the dead zone, +-1 at full deflection;
/// odd, continuous, rising.
double shapedDeflection(double deflection, const RateSettings& settings) noexcept;

}  // namespace nearfit
