#pragma once

#include <cstdint>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/leaf_pair.h"

namespace nearfit {

/// Way of a part between two poses on which a point of it moves straight and it turns about that point at one
/// rate.
struct PartWay {
  RigidTransform from, to;  ///< sceneFromPart, between the frames of the meshes.
  double travel = 0.0;      ///< No point of the part moves farther [m].
  /// No point of the part strays farther from the straight line between its places at both ends [m].
  double bend = 0.0;
};

/// Returns PartWay::bend for a turn [rad] of a part with that radius about the point that moves straight [m]: the
/// height of an arc over its chord.
constexpr double bendOf(double turn, double radius) noexcept {
  return 0.125 * radius * turn * turn;
}

/// Finds how near pairs of features come while the part goes a way, which may be much longer than they are
/// apart.
///
/// A direction along which two convex features are apart at both ends of the way separates them all along it, but
/// for the bend. So a part that slides along a wall is known not to meet it however far it goes. Real-time safe.
class PairPassage {
 public:
  /// @param enough  A bound beyond this [m] is as good as any.
  PairPassage(const NormalConeTree& scene, const NormalConeTree& part, const PartWay& way,
              double enough) noexcept;

  /// Lower bound on the distance of two features anywhere on the way [m]; negative if nothing is known.
  double leastOf(const LeafPair& pair) const noexcept;
  /// The least of several; infinity without any.
  double leastOf(std::span<const LeafPair> pairs) const noexcept;

 private:
  const NormalConeTree &scene_, &part_;
  glm::dmat3 turnFrom_, turnTo_;  ///< Between the trees' centred frames, like the shifts.
  glm::dvec3 shiftFrom_, shiftTo_;
  double travel_, lost_, enough_;  ///< lost_: by the bend and by rounding [m].
};

}  // namespace nearfit
