#include "tests/support/idle_features.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/proximity/hierarchy/normal_cone_tree_builder.h"
#include "core/proximity/query/leaf_tests.h"
#include "core/proximity/query/query_workspace.h"

namespace nearfit::test {
namespace {

/// Max rounding error of half the angle between two face normals [rad].
constexpr double kArcPadding = 1e-12;

class IdleFeatureFinder {
 public:
  IdleFeatureFinder(const TriangleMesh& mesh, MeshFeatures& features)
      : mesh_(mesh), out_(features), normals_(mesh.triangles().size(), glm::dvec3(0.0)) {
    for (const FaceFeature& f : features.faces)
      normals_[f.face] = f.cone.axis;
  }

  void add() {
    std::vector<bool> isThere(mesh_.edges().size());
    for (const EdgeFeature& f : out_.edges)
      isThere[f.edge] = true;
    for (std::uint32_t e = 0; e < mesh_.edges().size(); ++e) {
      if (!isThere[e]) addEdge(e);
    }
    isThere.assign(mesh_.vertices().size(), false);
    for (const VertexFeature& f : out_.vertices)
      isThere[f.vertex] = true;
    for (std::uint32_t v = 0; v < mesh_.vertices().size(); ++v) {
      if (!isThere[v]) addVertex(v);
    }
  }

 private:
  bool hasArea(std::uint32_t face) const { return normals_[face] != glm::dvec3(0.0); }

  /// True if the edge has two faces with area and consistent orientation.
  bool hasSide(std::uint32_t edge) const {
    return mesh_.isEdgeConsistent(edge) &&
           std::ranges::all_of(mesh_.facesOfEdge(edge), [this](std::uint32_t f) { return hasArea(f); });
  }

  std::uint32_t opposite(std::uint32_t face, const MeshEdge& edge) const {
    const Triangle& t = mesh_.triangles()[face];
    return *std::ranges::find_if(t, [&](std::uint32_t v) { return v != edge.v0 && v != edge.v1; });
  }

  void addEdge(std::uint32_t e) {
    if (!hasSide(e)) return;
    const MeshEdge& edge = mesh_.edges()[e];
    const auto faces = mesh_.facesOfEdge(e);
    const glm::dvec3 sum = normals_[faces[0]] + normals_[faces[1]];
    const glm::dvec3 along = mesh_.vertices()[edge.v1] - mesh_.vertices()[edge.v0];
    // Perpendicular to the edge, as the hierarchy requires. Normals of thin faces are so only up to rounding.
    const glm::dvec3 axis = sum - along * (glm::dot(sum, along) / glm::dot(along, along));
    const double length = glm::length(axis);
    if (!(length > 0.0)) return;  // Folded onto itself: the arc has no middle.
    const double halfAngle = 0.5 * angleBetween(normals_[faces[0]], normals_[faces[1]]);
    out_.edges.push_back(
        {e, {opposite(faces[0], edge), opposite(faces[1], edge)}, {axis / length, halfAngle + kArcPadding}});
  }

  void addVertex(std::uint32_t v) {
    const auto edges = mesh_.edgesOfVertex(v);
    if (edges.empty() || !std::ranges::all_of(edges, [this](std::uint32_t e) { return hasSide(e); })) return;
    const auto first = static_cast<std::uint32_t>(out_.neighbours.size());
    cones_.clear();
    for (const std::uint32_t e : edges) {
      const MeshEdge& edge = mesh_.edges()[e];
      out_.neighbours.push_back(edge.v0 == v ? edge.v1 : edge.v0);
      for (const std::uint32_t f : mesh_.facesOfEdge(e))
        cones_.push_back({normals_[f], 0.0});
    }
    out_.vertices.push_back({v, first, static_cast<std::uint32_t>(edges.size()), 0, boundingCone(cones_)});
  }

  const TriangleMesh& mesh_;
  MeshFeatures& out_;
  std::vector<glm::dvec3> normals_;  ///< Zero for faces without area.
  std::vector<NormalCone> cones_;
};

/// Builds a hierarchy with idle features, and counts them.
NormalConeTree fullTree(const TriangleMesh& mesh, FeatureCounts& idle) {
  MeshFeatures features = findFeatures(mesh);
  const std::size_t vertices = features.vertices.size(), edges = features.edges.size();
  addIdleFeatures(mesh, features);
  idle = {features.vertices.size() - vertices, features.edges.size() - edges, 0};
  const ProgressCallback nobody;
  return NormalConeTree(NormalConeTreeBuilder(mesh, nobody, std::move(features)).build());
}

}  // namespace

void addIdleFeatures(const TriangleMesh& mesh, MeshFeatures& features) {
  IdleFeatureFinder(mesh, features).add();
}

FullHierarchy::FullHierarchy(const TriangleMesh& mesh) : tree_(fullTree(mesh, idle_)) {}

bool FullHierarchy::isIdle(std::uint32_t leaf) const noexcept {
  const FeatureKind kind = NormalConeTree::leafKind(leaf);
  const std::uint32_t index = NormalConeTree::leafIndex(leaf);
  return (kind == FeatureKind::Vertex && index >= tree_.vertices().size() - idle_.vertices) ||
         (kind == FeatureKind::Edge && index >= tree_.edges().size() - idle_.edges);
}

LmdResult findLmds(const FullHierarchy& scene, const FullHierarchy& part, const RigidTransform& sceneFromPart,
                   double cutoff, LmdScratch& scratch, std::span<Lmd> out) noexcept {
  const NormalConeTree &sceneTree = scene.tree(), &partTree = part.tree();
  if (!isQueryValid(sceneTree, partTree, sceneFromPart, cutoff)) return LmdResult{.completeTo = cutoff};
  LmdScratch::Data& workspace = scratch.data();
  const RigidTransform pose = centredPose(sceneTree, partTree, sceneFromPart);
  const LeafTests tests(sceneTree, partTree, pose, cutoff);
  LmdResult result;
  result.completeTo = cutoff;
  MinimaCollector collector(workspace, result);
  TreeTraversal traversal(sceneTree, partTree, pose, cullLimits(sceneTree, partTree, pose, cutoff),
                          workspace.open, workspace.traversal);
  traversal.run([&](const EntryPair& pair) {
    ++result.leafPairs;
    traversal.spend(1);
    const bool isFound = tests.test(pair.scene, pair.part, collector.slot());
    if (isFound && !scene.isIdle(pair.scene) && !part.isIdle(pair.part)) collector.add();
  });
  result.nodePairs = traversal.nodePairs() - result.leafPairs;
  collector.finish(sceneTree, partTree, out);
  return result;
}

}  // namespace nearfit::test
