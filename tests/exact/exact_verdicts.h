#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"
#include "core/scene/scene.h"
#include "core/verdict/scene_check.h"

/// What a check of a scene says of each pair of parts, held against exact arithmetic that shares nothing with it but the
/// searched meshes and their poses.
namespace nearfit::test {

/// How two bodies are to each other, by exact predicates and exact distances of triangles; trees of boxes leave out what
/// is farther apart. The part's vertices are rounded where the pose puts them.
class ExactBodies {
 public:
  ExactBodies(const TriangleMesh& scene, const TriangleMesh& part);
  ~ExactBodies();
  ExactBodies(ExactBodies&&) noexcept;

  /// Whether the surfaces have a point in common.
  bool doSurfacesMeet(const RigidTransform& sceneFromPart) const;
  /// Least distance of the surfaces, or `most` where that is less [m]; to 1e-14 of the largest coordinate.
  double leastDistance(const RigidTransform& sceneFromPart, double most) const;
  /// Whether one body, or a piece of it, is inside the other, where surfaces do not meet. Only meshes that run as often
  /// one way along each edge as the other enclose anything.
  bool isOneInside(const RigidTransform& sceneFromPart) const;
  /// True if they do not meet and neither is inside the other.
  bool isFree(const RigidTransform& sceneFromPart) const;
  /// Whether a translation of that length frees bodies that meet: along the normals of some triangles that meet, or the
  /// axes of the scene's mesh.
  bool isFreedBy(double length, const RigidTransform& sceneFromPart) const;

 private:
  struct Bodies;
  std::unique_ptr<const Bodies> bodies_;
};

/// Result of a comparison.
struct VerdictComparison {
  std::size_t pairs = 0, agree = 0;
  /// By exact arithmetic.
  std::size_t clear = 0, near = 0, touching = 0, clashes = 0, contained = 0;
  double worstDistance = 0.0;            ///< Largest difference of two distances of a near pair [m].
  std::vector<std::string> differences;  ///< A sentence for each pair that does not agree.
};

/// Depths and volumes of clashes held against independent arithmetic.
struct ClashComparison {
  std::size_t clashes = 0;  ///< Clashes and contained parts.
  std::size_t depths = 0;   ///< Thereof those with a depth.
  std::size_t freed = 0;    ///< Depths whose translation frees the pair by exact predicates.
  std::size_t least =
      0;  ///< Depths less of which, by kDepthTolerance, does not free it in the same direction.
  /// Depths that another direction beats: one of those that isFreedBy() tries frees the pair by a shorter way. No fault where
  /// the depth is not said to be exact.
  std::size_t beaten = 0;
  std::size_t exactDepths = 0;    ///< Said to be the least in all directions.
  std::size_t exactLeast = 0;     ///< Thereof those where the tried directions have no shorter one.
  std::size_t volumes = 0;        ///< Clashes with a volume.
  std::size_t raysAgree = 0;      ///< Volumes that rays through both bodies confirm to kRayTolerance.
  std::size_t booleans = 0;       ///< Volumes that were computed again by Nef polyhedra.
  std::size_t booleansAgree = 0;  ///< Thereof to kBooleanTolerance.
  double worstRays = 0.0, worstBoolean = 0.0;  ///< Largest relative differences.
  std::vector<std::string> differences;        ///< A sentence for each that does not agree.

  /// Adds the counts of another comparison.
  void add(const ClashComparison& other);
};

/// Bounds on differences, as shares: of a depth; of a volume by booleans, and by rays, where it is more than a
/// ten-thousandth of the smaller body's box, else as a share of a ten-thousandth of that box.
constexpr double kDepthTolerance = 1e-6, kBooleanTolerance = 1e-9, kRayTolerance = 0.02;

/// Options of compareClashes().
struct ClashComparisonOptions {
  std::size_t cells = 600;                 ///< See sharedVolumeByRays().
  std::size_t maxBooleanTriangles = 2000;  ///< Larger pairs get no boolean.
  std::size_t maxBooleans = 20;            ///< Max in a check; the first in its order.
};

/// Holds depths and volumes of the clashes of a check against exact predicates, rays and another boolean. Rays on all
/// processors, booleans one after the other.
/// @param check  Of this request, with depths and volumes.
ClashComparison compareClashes(const SceneCheckRequest& request, const SceneCheck& check,
                               const ClashComparisonOptions& options = {});

/// Compares all pairs of a check without rules. On all processors.
/// @param check  Of this request.
VerdictComparison compareVerdicts(const SceneCheckRequest& request, const SceneCheck& check);

/// A scene with all parts drawn apart from its middle by a factor (below 1: pushed into each other), and each a little
/// moved and turned at random. Same seed, same scene.
Scene spreadScene(const Scene& scene, double factor, std::uint64_t seed);

/// The pieces of a mesh that have no vertex in common, in the order of their first triangles.
std::vector<TriangleMesh> meshPieces(const TriangleMesh& mesh);

}  // namespace nearfit::test
