#pragma once

#include <array>

#include "core/haptics/rate_settings.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// A device that is driven by pushing it.
class RateDriven {
 public:
  virtual ~RateDriven() = default;
  /// Controlling thread, running or not. Throws UsageError that says what is out of range.
  virtual void setRate(const RateSettings& settings) = 0;
};

/// A pose that deflections drive by its velocity: the handle of devices that sense pushing, not place.
///
/// Such a device has no force to stop the hand with, and the handle would wander off while the part stands at
/// a wall: it would have to be driven all the way back before the part lets go. So motion against the force
/// on the handle is slowed down as the force comes near to `leashForce`, and stops there; the same for
/// torque. Real-time safe.
class RateControl {
 public:
  RateControl(double leashForce, double leashTorque) noexcept
      : leashForce_(leashForce), leashTorque_(leashTorque) {}

  void restart(const RigidTransform& pose) noexcept { pose_ = pose; }

  /// One step of `time` [s] (more than kLongestStep counts as that).
  /// @param axes    Deflections along and about x, y, z, -1 to 1, in the frame of the pose's parent.
  /// @param wrench  On the handle, in the same frame.
  const RigidTransform& step(const std::array<double, 6>& axes, const RateSettings& settings,
                             const Wrench& wrench, double time) noexcept;

  /// A pause of the servo must not become a jump.
  static constexpr double kLongestStep = 0.02;

 private:
  double leashForce_, leashTorque_;
  RigidTransform pose_;
};

/// The curve of one axis: 0 within the dead zone, +-1 at full deflection, odd, continuous, rising.
double shapedDeflection(double deflection, const RateSettings& settings) noexcept;

}  // namespace nearfit
