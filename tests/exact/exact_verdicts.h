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

/// Compares all pairs of a check without rules. On all processors.
/// @param check  Of this request.
VerdictComparison compareVerdicts(const SceneCheckRequest& request, const SceneCheck& check);

/// A scene with all parts drawn apart from its middle by a factor (below 1: pushed into each other), and each a little
/// moved and turned at random. Same seed, same scene.
Scene spreadScene(const Scene& scene, double factor, std::uint64_t seed);

/// The pieces of a mesh that have no vertex in common, in the order of their first triangles.
std::vector<TriangleMesh> meshPieces(const TriangleMesh& mesh);

}  // namespace nearfit::test
