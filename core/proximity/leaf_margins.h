#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// What rounding can do to the conditions of the leaf tests at one pose, from the magnitudes that enter them.
/// A condition that holds by more than its bound here holds in exact arithmetic on the meshes and the pose as
/// they are given; one that holds by less, or that only a tolerance lets pass, is marginal.
///
/// u is half the spacing of doubles at 1. Coordinates in a mesh's centred frame carry two roundings of its
/// size: local error. A point that is brought into the other frame carries those of the quaternion's length
/// (twice, as a rotation is quadratic in it), of the rotation (some ten operations) and of the sum besides,
/// each of a number no larger than both bodies and the way between them: point error. What the centred pose
/// was made from may be larger. Real-time safe.
class LeafMargins {
 public:
  /// @param sceneFromPart  Between the trees' centred frames.
  LeafMargins(const NormalConeTree& scene, const NormalConeTree& part,
              const RigidTransform& sceneFromPart) noexcept;

  double pointError() const noexcept { return pointError_; }  ///< Of a point in the other's frame [m].

  /// Of a direction between two points that are that far apart [rad].
  double turnOfPoints(double distance) const noexcept { return 2.0 * pointError_ / distance + kTurn; }
  /// Of a face's normal [rad]: what moves its corners turns it by that over its height.
  static double turnOfFace(const NormalConeTree& tree, double leastHeight) noexcept {
    return 2.0 * localError(tree) / leastHeight + kTurn;
  }
  /// Of an edge's direction [rad].
  static double turnOfEdge(const NormalConeTree& tree, double length) noexcept {
    return 2.0 * localError(tree) / length + kTurn;
  }

  /// Whether all walls of a vertex's polar cone are farther from d than rounding goes.
  /// @param turn  Error of `d` [rad]. `d` is unit, in the frame of `tree`.
  static bool isClearOfVertex(const NormalConeTree& tree, std::uint32_t vertex, const glm::dvec3& d,
                              double turn) noexcept;
  /// Likewise those of an edge's polar arc.
  /// @param start, along, length  Of the edge; `along` is unit.
  static bool isClearOfEdge(const NormalConeTree& tree, std::uint32_t edge, const glm::dvec3& start,
                            const glm::dvec3& along, double length, const glm::dvec3& d,
                            double turn) noexcept;
  /// Whether a foot on a face is farther from its sides than `error` [m].
  static bool isClearInFace(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& normal,
                            const glm::dvec3& foot, double error) noexcept;
  /// Whether a place along an edge is farther from its ends than `error` [m].
  static bool isClearAlong(double place, double length, double error) noexcept {
    return place > error && place < length - error;
  }

 private:
  static constexpr double kUnit = 0x1p-53;
  /// Of a unit vector that was normalised and turned: two dozen roundings.
  static constexpr double kTurn = 24.0 * kUnit;
  static double localError(const NormalConeTree& tree) noexcept { return 4.0 * kUnit * tree.size(); }

  double pointError_;
};

}  // namespace nearfit
