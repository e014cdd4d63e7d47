#include "core/haptics/spring_law.h"

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// Force of one minimum along its direction [N]; >= 0, or NaN if an input is.
double pushOf(const Lmd& lmd, const SpringParameters& p, const glm::dvec3& velocity) noexcept {
  const double compression = p.cutoff - lmd.distance;
  if (compression <= 0.0) return 0.0;
  double push = p.stiffness * compression;
  if (p.law == SpringLaw::Printed) push *= lmd.distance;
  push -= p.damping * glm::dot(lmd.direction, velocity);
  // NaN passes this test: the caller must see it, not a force that looks right.
  return push < 0.0 ? 0.0 : push;
}

}  // namespace

Wrench springWrench(std::span<const Lmd> lmds, const SpringParameters& parameters,
                    const glm::dvec3& centreOfMass, const Twist& twist) noexcept {
  Wrench sum;
  for (const Lmd& lmd : lmds) {
    if (lmd.isBlocked || lmd.isMerged) continue;
    const glm::dvec3 arm = lmd.partPoint - centreOfMass;
    const glm::dvec3 velocity = twist.linear + glm::cross(twist.angular, arm);
    const glm::dvec3 force = pushOf(lmd, parameters, velocity) * lmd.direction;
    sum.force += force;
    sum.torque += glm::cross(arm, force);
  }
  return sum;
}

}  // namespace nearfit
