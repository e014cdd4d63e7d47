#pragma once

#include <array>
#include <optional>

#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"
#include "tests/support/simulated_hand.h"

namespace nearfit::stress {

/// A hand with device: mass and damping, and a grip that draws it to where it is wanted, as far as it is
/// strong, and damps whatever it draws.
struct HandBody {
  double mass = 0.25, damping = 1.0;              ///< [kg], [N s/m]: of the device, a light one in hand.
  double inertia = 2e-4, rotDamping = 1e-3;       ///< [kg m^2], [N m s/rad]
  double grip = 200.0, gripDamping = 4.0;         ///< [N/m], [N s/m]
  double gripTurn = 1.0, gripTurnDamping = 0.02;  ///< [N m/rad], [N m s/rad]
  double strength = 20.0, turnStrength = 1.0;     ///< [N], [N m]
};

/// Moves under wrenches that are held over each period; about the part's centre of mass.
class HeldHand {
 public:
  HeldHand(const HandBody& body, const glm::dvec3& centreInPart, const RigidTransform& start);

  /// @param wanted  Where the grip draws it.   @param wrench  On the hand, about the centre of mass.
  void step(const RigidTransform& wanted, const Wrench& wrench, double period);

  RigidTransform pose() const;
  glm::dvec3 centre() const;
  glm::dvec3 velocity() const;

 private:
  HandBody body_;
  glm::dvec3 centreInPart_, origin_;
  std::array<test::SimulatedHand, 3> shift_;  ///< Of the centre, from `origin_`.
  glm::dquat rotation_;
  glm::dvec3 spin_{0.0};
};

}  // namespace nearfit::stress
