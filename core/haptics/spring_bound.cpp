#include "core/haptics/spring_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/haptics/virtual_coupling.h"

namespace nearfit {
namespace {

/// A share this near to the wanted one is it: rising would never end.
constexpr double kShareRest = 1e-6;

/// Largest eigenvalue of a positive semidefinite symmetric matrix; >= 0, NaN or infinity if an entry is.
/// Source: Smith 1961, Eigenvalues of a symmetric 3 x 3 matrix.
double largestEigenvalue(const glm::dmat3& m) noexcept {
  const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
  const glm::dmat3 rest = m - mean * glm::dmat3(1.0);
  double squares = 0.0;
  for (glm::length_t i = 0; i < 3; ++i)
    squares += glm::dot(rest[i], rest[i]);
  const double spread = std::sqrt(squares / 6.0);
  // To be divided by; below the rounding of the mean all three are equal.
  constexpr double kEqual = 1e-14;
  if (spread <= kEqual * mean) return mean;
  const double cosine = std::clamp(0.5 * glm::determinant(rest / spread), -1.0, 1.0);
  return mean + 2.0 * spread * std::cos(std::acos(cosine) / 3.0);
}

/// Part of a load that a bound bears; 1 without load.
double shareOf(double bound, double load) noexcept {
  return load > bound ? bound / load : 1.0;
}

double ratioOfLoad(double load, double bound) noexcept {
  return load > 0.0 ? load / bound : 0.0;
}

double risen(double last, double wanted, double share) noexcept {
  if (!(wanted > last)) return wanted;
  const double next = last + share * (wanted - last);
  return wanted - next < kShareRest ? wanted : next;
}

}  // namespace

void SpringDirections::add(std::span<const Lmd> lmds, const SpringParameters& springs,
                           const glm::dvec3& centreOfMass) noexcept {
  for (const Lmd& lmd : lmds) {
    if (lmd.isBlocked || lmd.isMerged || !(lmd.distance < springs.cutoff)) continue;
    const glm::dvec3 turn = glm::cross(lmd.partPoint - centreOfMass, lmd.direction);
    lines_ += glm::outerProduct(lmd.direction, lmd.direction);
    turns_ += glm::outerProduct(turn, turn);
  }
}

double SpringDirections::alongOneLine() const noexcept {
  return largestEigenvalue(lines_);
}

double SpringDirections::aboutOneAxis() const noexcept {
  return largestEigenvalue(turns_);
}

double slopeOf(const SpringParameters& springs) noexcept {
  return springs.law == SpringLaw::Printed ? springs.stiffness * springs.cutoff : springs.stiffness;
}

SpringShares boundedSprings(const SpringDirections& directions, const SpringParameters& springs,
                            const DeviceLimits& device, double period) noexcept {
  const double lines = directions.alongOneLine();
  // Of a device without torque the springs' torque goes nowhere.
  const double turns = device.maxTorque > 0.0 ? directions.aboutOneAxis() : 0.0;
  const double slope = slopeOf(springs);
  // The wrench is to show it.
  if (!std::isfinite((springs.damping + slope) * (lines + turns))) return {};
  const double damped = ratioOfLoad(springs.damping * lines, device.damping) +
                        ratioOfLoad(springs.damping * turns, device.rotationalDamping);
  const double linear = ratioOfLoad(slope * lines, stiffnessBound(device.damping, 0.0, period));
  const double angular = ratioOfLoad(slope * turns, stiffnessBound(device.rotationalDamping, 0.0, period));
  SpringShares shares;
  shares.damping = shareOf(kMaxDampingShare, damped);
  const double left = 1.0 - std::min(kMaxDampingShare, damped);
  shares.wrench = shareOf(left, linear + angular);
  return shares;
}

SpringShares risenShares(const SpringShares& last, const SpringShares& wanted, double period) noexcept {
  const double share = period / (kShareRiseTime + period);
  return {risen(last.wrench, wanted.wrench, share), risen(last.damping, wanted.damping, share)};
}

}  // namespace nearfit
