#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/features.h"
#include "core/parallel/shared_progress.h"
#include "core/proximity/hierarchy/feature_geometry.h"
#include "core/proximity/hierarchy/feature_set_bounds.h"
#include "core/proximity/hierarchy/feature_set_splitter.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {

/// Builds a NormalConeTree: halves the features until each stands alone, so that all nodes but the last few
/// are full, and bounds each set of features by a box along its own axes. See FeatureSetSplitter and FeatureSetBounds.
class NormalConeTreeBuilder {
 public:
  NormalConeTreeBuilder(const TriangleMesh& mesh, const ProgressCallback& progress, AcceptanceRule rule)
      : mesh_(mesh), progress_(progress, 1.0), rule_(rule) {}
  /// @param merged  Kept by reference.
  NormalConeTreeBuilder(const FlatMesh& merged, const ProgressCallback& progress)
      : mesh_(merged.mesh), progress_(progress, 1.0), flatOf_(merged.flatOf), deviation_(merged.deviation) {}
  /// For these features of the mesh in place of those that findFeatures() finds.
  NormalConeTreeBuilder(const TriangleMesh& mesh, const ProgressCallback& progress, MeshFeatures features)
      : mesh_(mesh), progress_(progress, 1.0), features_(std::move(features)), hasFeatures_(true) {}
  /// Call once. Throws Cancelled, and Error if the mesh is too large.
  NormalConeTree::Arrays build();

 private:
  /// One feature to place in the tree; single precision suffices for sorting.
  struct Item {
    std::array<float, 3> centre;  ///< Centre of the feature's box, relative to the tree's centre [m].
    std::uint32_t feature;
  };
  using Items = std::span<Item>;

  /// Subtree built on its own, with the lane that will hold it; inserted afterwards.
  struct Subtree {
    std::uint32_t parent;
    std::size_t lane;
    Items items;
    NormalConeTree::Bound bound;
    std::vector<NormalConeTree::Node> nodes;
  };

  /// Hierarchy under construction.
  struct Growing {
    glm::dvec3 centre{0.0};
    double size = 0.0;
    std::vector<NormalConeTree::Node> nodes;
    std::vector<glm::dvec3> positions;
    std::vector<NormalConeTree::VertexLeaf> vertices;
    std::vector<NormalConeTree::EdgeLeaf> edges;
    std::vector<NormalConeTree::FaceLeaf> faces;
  };

  void findFeaturesOfMesh();
  void fillLeaves();
  std::vector<Item> makeItems() const;
  static void halveLarge(Items items, std::size_t cut);
  NormalConeTree::Bound boundOfMany(Items items) const;
  std::uint32_t buildLarge(Items items, std::vector<Subtree>& putOff);
  void buildSubtree(Subtree& subtree) const;
  void buildSubtrees(std::vector<Subtree>& subtrees);
  void reportSplit(std::size_t items);
  void buildRoot(Items items);
  std::uint32_t leafChild(std::uint32_t feature) const;

  const TriangleMesh& mesh_;
  SharedProgress progress_;
  AcceptanceRule rule_ = AcceptanceRule::Exact;
  std::span<const std::uint32_t> flatOf_;
  double deviation_ = 0.0;
  double splitsReported_ = 0.0;
  Growing tree_;
  MeshFeatures features_;
  bool hasFeatures_ = false;
  std::vector<glm::dvec3> walls_;
  std::optional<FeatureGeometry> geometry_;
};

}  // namespace nearfit
