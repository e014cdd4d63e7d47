#pragma once

#include <cstdint>
#include <random>

#include "core/math/rigid_transform.h"
#include "tests/stress/stress_scene.h"

namespace nearfit::stress {

enum class MotionKind : std::uint8_t { Teleport, Impact, Shake, Grind, GapWalk, Spin, Home, Rest };
constexpr int kMotionKinds = 8;
const char* nameOf(MotionKind kind) noexcept;

/// Where an adversarial hand wants the part: stretches of motions of all kinds, one after the other by a
/// seeded schedule. It sees where the part is, so as to press it where it is.
class HandMotion {
 public:
  HandMotion(const StressScene& scene, std::uint64_t seed);

  /// The next place: worldFromPart.
  /// @param proxy  Where the part is.   @param period  Since the call before [s].
  RigidTransform next(const RigidTransform& proxy, double period);
  MotionKind kind() const noexcept { return kind_; }

 private:
  /// A pose by its centre of mass, about which the hand turns.
  struct Place {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 centre{0.0};
  };

  Place placeOf(const RigidTransform& pose) const noexcept;
  RigidTransform poseOf(const Place& place) const noexcept;
  void begin(const Place& proxy);
  void beginTeleport();
  void beginPress(const Place& proxy);
  Place placeNow(const Place& proxy, double period);
  Place walked(const Place& proxy);
  glm::dquat randomRotation();
  double in(double low, double high);
  /// Uniform in its logarithm.
  double ofSize(double low, double high);

  StressScene scene_;
  glm::dvec3 centreInPart_;
  std::mt19937_64 random_;
  MotionKind kind_ = MotionKind::Home;
  std::uint64_t ticksLeft_ = 0;
  double time_ = 0.0;  ///< In the stretch [s].
  Place from_, now_;
  glm::dvec3 along_{1.0, 0.0, 0.0}, across_{0.0, 1.0, 0.0}, axis_{0.0, 0.0, 1.0};
  double speed_ = 0.0, turnSpeed_ = 0.0, amplitude_ = 0.0;
};

}  // namespace nearfit::stress
