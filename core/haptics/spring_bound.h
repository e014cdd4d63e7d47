#pragma once

#include <span>

#include <glm/mat3x3.hpp>

#include "core/haptics/device_limits.h"
#include "core/haptics/spring_law.h"
#include "core/proximity/lmd.h"

namespace nearfit {

/// Directions in which springs push, each as a square: a sum of springs of stiffness k is as stiff as k times these.
class SpringDirections {
 public:
  /// Adds the minima that push under these springs, as springWrench() has it. Real-time safe.
  void add(std::span<const Lmd> lmds, const SpringParameters& springs,
           const glm::dvec3& centreOfMass) noexcept;

  /// Springs that act along the line on which most do: the largest eigenvalue of the sum of u u^T.
  double alongOneLine() const noexcept;
  /// The same of turns about the centre of mass [m^2]: of the sum of (r x u) (r x u)^T.
  double aboutOneAxis() const noexcept;

 private:
  glm::dmat3 lines_{0.0}, turns_{0.0};
};

/// Parts of the springs' wrench and damping that are rendered; 1 where nothing is held back. Force and torque have one
/// share: with two, springs off the centre of mass would give more around a closed way than they take.
struct SpringShares {
  double wrench = 1.0, damping = 1.0;
  bool isHeld() const noexcept { return wrench < 1.0 || damping < 1.0; }
  bool operator==(const SpringShares&) const = default;
};

/// Largest slope of a spring's force over its distance: the stiffness, of the printed law stiffness times cutoff [N/m].
double slopeOf(const SpringParameters& springs) noexcept;

/// The part of a sum of springs that a device bears. With the device's damping b, and the stiffness K and damping B of
/// the springs along one line, and the same for turns about one axis:
///
///     (K T / 2 + B) / b  of translation  +  (K T / 2 + B) / b  of turns  <=  1
///
/// A spring off the centre of mass acts on both, and the sum bounds what it does to them together: b - K T / 2 - B stays
/// positive semidefinite in all six directions, which alone is Colgate's bound (stiffnessBound()). Damping takes at most
/// kMaxDampingShare, and the wrench is held back to the rest.
///
/// @param device  Limits at the handle (limitsAtHandle()); without torque, only forces count.
/// @param period  Measured (PeriodMeter) [s].
/// Where the springs' numbers overflow all shares are 1: the wrench then is a fault. Zero shares where the bound has no
/// meaning. Real-time safe. Source: Colgate & Schenkel 1997; the bound on both together is ours. It leaves out how
/// directions turn as the part moves (a spring's force over its distance, across it).
SpringShares boundedSprings(const SpringDirections& directions, const SpringParameters& springs,
                            const DeviceLimits& device, double period) noexcept;

/// Time constant with which shares rise again [s]; they fall at once. A spring that comes and goes from tick to tick
/// would otherwise change the force of all others as often.
inline constexpr double kShareRiseTime = 0.1;

/// The shares of this tick after those of the last. Real-time safe.
SpringShares risenShares(const SpringShares& last, const SpringShares& wanted, double period) noexcept;

}  // namespace nearfit
