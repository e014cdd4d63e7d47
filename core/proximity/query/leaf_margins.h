#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {

/// Bounds on what rounding can do to the conditions of the leaf tests at one pose, from the magnitudes that
/// enter them. A condition that holds by more than its bound holds in exact arithmetic, for the meshes and
/// the pose as given. One that holds by less, or only within a tolerance, is marginal.
///
/// kUnit is half the spacing of doubles at 1. Coordinates in a mesh's centred frame carry two roundings of
/// its size: local error. A point mapped into the other frame also carries the roundings of the quaternion's
/// length (twice, as a rotation is quadratic in it), of the rotation (some ten operations) and of the sum,
/// each of a number no larger than both bodies plus the distance between them: point error. The numbers that
/// the centred pose was made from may be larger. Real-time safe.
class LeafMargins {
 public:
  /// @param sceneFromPart  Between the trees' centred frames.
  LeafMargins(const NormalConeTree& scene, const NormalConeTree& part,
              const RigidTransform& sceneFromPart) noexcept;

  /// Error of a point mapped into the other frame [m].
  double pointError() const noexcept { return pointError_; }

  /// Error of a direction between two points that are `distance` apart [rad].
  double angularErrorOfPoints(double distance) const noexcept { return 2.0 * pointError_ / distance + kTurn; }
  /// Error of a face's normal [rad]: an error of its corners, divided by its height.
  static double angularErrorOfFace(const NormalConeTree& tree, double leastHeight) noexcept {
    return 2.0 * localError(tree) / leastHeight + kTurn;
  }
  /// Error of an edge's direction [rad].
  static double angularErrorOfEdge(const NormalConeTree& tree, double length) noexcept {
    return 2.0 * localError(tree) / length + kTurn;
  }

  /// True if `d` is farther from all walls of a vertex's polar cone than rounding reaches.
  /// @param d     Unit, in the frame of `tree`.
  /// @param turn  Error of `d` [rad].
  static bool isClearOfVertex(const NormalConeTree& tree, std::uint32_t vertex, const glm::dvec3& d,
                              double turn) noexcept;
  /// The same for an edge's polar arc.
  /// @param start, along, length  The edge; `along` is unit.
  static bool isClearOfEdge(const NormalConeTree& tree, std::uint32_t edge, const glm::dvec3& start,
                            const glm::dvec3& along, double length, const glm::dvec3& d,
                            double turn) noexcept;
  /// True if a point `foot` on a face is farther from its sides than `error` [m].
  static bool isClearInFace(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& normal,
                            const glm::dvec3& foot, double error) noexcept;
  /// True if a place along an edge is farther from both ends than `error` [m].
  static bool isClearAlong(double place, double length, double error) noexcept {
    return place > error && place < length - error;
  }

 private:
  static constexpr double kUnit = 0x1p-53;
  /// Error of a unit vector after normalisation and rotation: two dozen roundings.
  static constexpr double kTurn = 24.0 * kUnit;
  static double localError(const NormalConeTree& tree) noexcept { return 4.0 * kUnit * tree.size(); }

  double pointError_;
};

}  // namespace nearfit
