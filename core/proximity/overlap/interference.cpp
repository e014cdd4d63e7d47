#include "core/proximity/overlap/interference.h"

#include <memory>
#include <optional>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/exact/triangle_predicates.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/overlap/containment.h"
#include "core/proximity/overlap/placed_mesh.h"
#include "core/proximity/query/broad_phase.h"
#include "core/proximity/query/query_workspace.h"
#include "core/proximity/query/tree_traversal.h"

namespace nearfit {
namespace {

/// Rounding of double-precision coordinates as a fraction of their distance from the origin: how far placed
/// vertices may be from where the hierarchies have them. Some ten roundings.
constexpr double kPlacing = 4e-15;

/// Node pairs opened between checks for triangles that meet.
constexpr std::uint64_t kBetweenLooks = 256;

/// Search for two triangles that meet.
class MeetingSearch {
 public:
  MeetingSearch(const PlacedMesh& scene, const PlacedMesh& part) : scene_(scene), part_(part) {}

  std::optional<Interference> find(const RigidTransform& sceneFromPart) {
    searchTrees(sceneFromPart);
    // Thin triangles are tested against everything; most meshes have none.
    testAll(scene_.looseTriangles(), part_.mesh().triangles().size(),
            [this](std::uint32_t loose, std::uint32_t other) { test(loose, other); });
    testAll(part_.looseTriangles(), scene_.mesh().triangles().size(),
            [this](std::uint32_t loose, std::uint32_t other) { test(other, loose); });
    return found_;
  }

 private:
  void searchTrees(const RigidTransform& sceneFromPart) {
    const NormalConeTree &scene = scene_.tree(), &part = part_.tree();
    if (scene.isEmpty() || part.isEmpty()) return;
    const RigidTransform centred = centredPose(scene, part, sceneFromPart);
    CullLimits limits = cullLimits(scene, part, centred, 0.0);
    const double farthest = glm::length(sceneFromPart.translation) + glm::length(part.centre()) +
                            glm::length(scene.centre()) + scene.size() + part.size();
    limits.padding += static_cast<float>(kPlacing * farthest);
    const auto work = std::make_unique<TraversalWork>();
    TreeTraversal traversal(scene, part, centred, limits, nearOpener(defaultSimdLevel()), *work);
    const auto visit = [&](const EntryPair& pair) {
      if (isFace(pair.scene) && isFace(pair.part)) {
        test(scene.faces()[NormalConeTree::leafIndex(pair.scene)].face,
             part.faces()[NormalConeTree::leafIndex(pair.part)].face);
      }
    };
    std::uint64_t allowed = kBetweenLooks;
    for (bool isDone = traversal.run(visit, allowed); !isDone && !found_; allowed += kBetweenLooks)
      isDone = traversal.goOn(visit, allowed + kBetweenLooks);
  }
  static bool isFace(std::uint32_t leaf) { return NormalConeTree::leafKind(leaf) == FeatureKind::Face; }

  template <class Test>
  void testAll(const std::vector<std::uint32_t>& loose, std::size_t others, Test&& test) {
    for (const std::uint32_t triangle : loose) {
      for (std::uint32_t other = 0; other < others && !found_; ++other)
        test(triangle, other);
    }
  }

  void test(std::uint32_t sceneTriangle, std::uint32_t partTriangle) {
    if (found_) return;
    const TriangleCorners a = scene_.corners(sceneTriangle), b = part_.corners(partTriangle);
    if (!doOverlap(boxOf(a), boxOf(b)) || !doTrianglesMeet(a, b)) return;
    found_ = {InterferenceKind::SurfacesMeet, sceneTriangle, partTriangle};
  }

  const PlacedMesh &scene_, &part_;
  std::optional<Interference> found_;
};

/// Returns a triangle of a component inside the solid of the other mesh. The surfaces must be apart.
std::optional<std::uint32_t> pieceInside(const PlacedMesh& inner, const MeshComponents& innerPieces,
                                         const PlacedSolid& solid) {
  for (const std::uint32_t triangle : innerPieces.firstTriangle) {
    if (solid.contains(inner.corners(triangle)[0])) return triangle;
  }
  return std::nullopt;
}

}  // namespace

Interference findInterference(const NormalConeTree& scene, const NormalConeTree& part,
                              const RigidTransform& sceneFromPart) {
  ComponentsOnDemand scenePieces, partPieces;
  return findInterference({scene, scenePieces}, {part, partPieces}, sceneFromPart);
}

Interference findInterference(const InterferenceBody& scene, const InterferenceBody& part,
                              const RigidTransform& sceneFromPart) {
  if (!sceneFromPart.isFinite()) throw UsageError("pose", "it is not finite", "give finite numbers");
  const PlacedMesh placedScene(scene.tree, nullptr), placedPart(part.tree, &sceneFromPart);
  if (const auto meeting = MeetingSearch(placedScene, placedPart).find(sceneFromPart)) return *meeting;
  // Most bodies that are apart have boxes that are: components cost time by the number of their triangles.
  if (!doOverlap(boundsOf(placedPart.mesh().bounds(), sceneFromPart), placedScene.mesh().bounds())) return {};

  const MeshComponents &scenePieces = scene.components.of(placedScene.mesh()),
                       &partPieces = part.components.of(placedPart.mesh());
  if (const auto triangle = pieceInside(placedPart, partPieces, PlacedSolid(placedScene, scenePieces))) {
    return {InterferenceKind::PartInside, Interference::kNone, *triangle};
  }
  if (const auto triangle = pieceInside(placedScene, scenePieces, PlacedSolid(placedPart, partPieces))) {
    return {InterferenceKind::SceneInside, *triangle, Interference::kNone};
  }
  return {};
}

}  // namespace nearfit
