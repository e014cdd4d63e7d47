#include "core/proximity/hierarchy/normal_cone_tree_builder.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/mesh/normal_span.h"
#include "core/parallel/parallel_for.h"
#include "core/proximity/hierarchy/subtree_builder.h"

namespace nearfit {
namespace {

/// Queries open larger sets whatever they hold, so these get no exact limits of direction and are split along
/// their widest axis without trials.
constexpr std::size_t kLargePart = 8192;

/// Approximate shares of the build time, for progress: finding features, splits by one thread, and the rest,
/// built on all processors.
constexpr double kFeaturesShare = 0.3, kSplitsShare = 0.2, kSubtreesShare = 0.5;

constexpr std::size_t kWidth = NormalConeTree::kWidth;

std::array<float, 3> toSingle(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Writes the lowest kind below each node to the child that refers to it. Children come after their parents.
void markLowestKinds(std::vector<NormalConeTree::Node>& nodes) {
  std::vector<FeatureKind> lowest(nodes.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    lowest[i] = FeatureKind::Face;
    for (std::uint32_t& child : nodes[i].child) {
      if (child == NormalConeTree::kNoChild) continue;
      if (!NormalConeTree::isLeaf(child)) child = NormalConeTree::nodeChild(child, lowest[child]);
      lowest[i] = std::min(lowest[i], NormalConeTree::lowestKind(child));
    }
  }
}

}  // namespace

NormalConeTree::Arrays NormalConeTreeBuilder::build() {
  constexpr std::size_t kMaxLeaves = (std::size_t{1} << 29) - 1;
  if (mesh_.edges().size() > kMaxLeaves) {
    throw Error("mesh", "it has more edges than a hierarchy can hold", "reduce the mesh first");
  }
  tree_.centre = mesh_.bounds().isEmpty() ? glm::dvec3(0.0) : mesh_.bounds().centre();
  tree_.size = mesh_.bounds().diagonal();
  tree_.positions.reserve(mesh_.vertices().size());
  for (const glm::dvec3& p : mesh_.vertices())
    tree_.positions.push_back(p - tree_.centre);
  findFeaturesOfMesh();
  geometry_.emplace(mesh_, features_, tree_.positions);
  fillLeaves();
  std::vector<Item> items = makeItems();
  if (!items.empty()) buildRoot(items);
  return {tree_.centre,
          tree_.size,
          std::move(tree_.nodes),
          std::move(tree_.positions),
          std::move(tree_.vertices),
          std::move(tree_.edges),
          std::move(tree_.faces),
          std::move(features_.neighbours),
          rule_,
          std::move(walls_),
          mesh_,
          deviation_};
}

void NormalConeTreeBuilder::findFeaturesOfMesh() {
  if (hasFeatures_) {
    progress_.add(kFeaturesShare);
    return;
  }
  double reported = 0.0;
  const auto report = [&](double fraction) {
    progress_.add(kFeaturesShare * (fraction - reported));
    reported = fraction;
  };
  if (rule_ == AcceptanceRule::NormalSpan) {
    NormalSpanFeatures found = findNormalSpanFeatures(mesh_, report);
    features_ = std::move(found.features);
    walls_ = std::move(found.walls);
  } else {
    features_ = findFeatures(mesh_, report, flatOf_);
  }
}

void NormalConeTreeBuilder::fillLeaves() {
  tree_.vertices.reserve(features_.vertices.size());
  for (const VertexFeature& f : features_.vertices) {
    tree_.vertices.push_back({f.vertex, f.firstNeighbour, f.neighbourCount});
  }
  tree_.edges.reserve(features_.edges.size());
  for (const EdgeFeature& f : features_.edges) {
    const MeshEdge& e = mesh_.edges()[f.edge];
    tree_.edges.push_back({f.edge, e.v0, e.v1, f.opposite});
  }
  tree_.faces.reserve(features_.faces.size());
  for (const FaceFeature& f : features_.faces)
    tree_.faces.push_back({f.face, mesh_.triangles()[f.face]});
}

std::vector<NormalConeTreeBuilder::Item> NormalConeTreeBuilder::makeItems() const {
  std::vector<Item> items(geometry_->size());
  constexpr std::size_t kChunk = 65536;
  parallelFor((items.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(items.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      const auto feature = static_cast<std::uint32_t>(i);
      const FeatureGeometry::Corners c = geometry_->corners(feature);
      Aabb box;
      for (std::size_t k = 0; k < c.count; ++k)
        box.add(c.points[k]);
      items[i] = {toSingle(box.centre()), feature};
    }
  });
  return items;
}

std::uint32_t NormalConeTreeBuilder::leafChild(std::uint32_t feature) const {
  const bool isVertex = feature < geometry_->edgeBase(),
             isEdge = !isVertex && feature < geometry_->faceBase();
  const FeatureKind kind = isVertex ? FeatureKind::Vertex : isEdge ? FeatureKind::Edge : FeatureKind::Face;
  const std::uint32_t base = isVertex ? 0 : isEdge ? geometry_->edgeBase() : geometry_->faceBase();
  return NormalConeTree::kLeafBit | static_cast<std::uint32_t>(kind) << 29 | (feature - base);
}

void NormalConeTreeBuilder::buildRoot(Items items) {
  tree_.nodes.reserve(items.size() / (kWidth - 1) + items.size() / 64 + 8);
  tree_.nodes.push_back(emptyNode());
  std::vector<Subtree> subtrees;
  if (items.size() <= kLargePart) {
    subtrees.push_back({0, 0, items, {}, {}});
  } else {
    subtrees.push_back({0, 0, items, {}, {}});
    const std::uint32_t child = buildLarge(items, subtrees);
    tree_.nodes[0].child[0] = child;
  }
  buildSubtrees(subtrees);
}

/// Builds the deferred subtrees on all processors. The tree does not depend on which thread builds what.
void NormalConeTreeBuilder::buildSubtrees(std::vector<Subtree>& subtrees) {
  progress_.add(kSplitsShare - splitsReported_);
  parallelFor(subtrees.size(), [&](std::size_t i) {
    Subtree& subtree = subtrees[i];
    if (subtree.items.size() > kLargePart) {
      subtree.bound = boundOfMany(subtree.items);
      return;
    }
    buildSubtree(subtree);
    progress_.add(kSubtreesShare * static_cast<double>(subtree.items.size()) /
                  static_cast<double>(geometry_->size()));
  });

  for (Subtree& subtree : subtrees) {
    NormalConeTree::Node& parent = tree_.nodes[subtree.parent];
    const auto offset = static_cast<std::uint32_t>(tree_.nodes.size());
    setLane(parent, subtree.lane, subtree.bound);
    if (subtree.items.size() > kLargePart) continue;
    parent.child[subtree.lane] = subtree.nodes.empty() ? leafChild(subtree.items[0].feature) : offset;
    for (NormalConeTree::Node& node : subtree.nodes) {
      for (std::uint32_t& child : node.child)
        child += NormalConeTree::isLeaf(child) ? 0 : offset;
    }
    tree_.nodes.insert(tree_.nodes.end(), subtree.nodes.begin(), subtree.nodes.end());
    subtree.nodes = {};
  }
  markLowestKinds(tree_.nodes);
}

/// Puts first the `cut` items that are lowest along the axis of greatest spread.
void NormalConeTreeBuilder::halveLarge(Items items, std::size_t cut) {
  Aabb box;
  for (const Item& item : items)
    box.add({item.centre[0], item.centre[1], item.centre[2]});
  const glm::dvec3 width = box.upper - box.lower;
  const std::size_t axis = width.x >= width.y && width.x >= width.z ? 0 : width.y >= width.z ? 1 : 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(cut), items.end(),
                   [axis](const Item& a, const Item& b) {
                     return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis]
                                                             : a.feature < b.feature;
                   });
}

/// Reports a split by one thread as its share of all halvings down to the deferred subtrees.
void NormalConeTreeBuilder::reportSplit(std::size_t items) {
  const auto all = static_cast<double>(geometry_->size());
  const double halvings = std::max(1.0, std::log2(all / static_cast<double>(kLargePart)));
  const double part =
      std::min(kSplitsShare * static_cast<double>(items) / (all * halvings), kSplitsShare - splitsReported_);
  splitsReported_ += part;
  progress_.add(part);
}

NormalConeTree::Bound NormalConeTreeBuilder::boundOfMany(Items items) const {
  std::vector<std::uint32_t> features;
  features.reserve(items.size());
  for (const Item& item : items)
    features.push_back(item.feature);
  return FeatureSetBounds(*geometry_, tree_.size).boundOfMany(features);
}

/// Adds a node over more than kLargePart items and returns its index. Defers bounds, and subtrees small
/// enough for one thread.
std::uint32_t NormalConeTreeBuilder::buildLarge(Items items, std::vector<Subtree>& putOff) {
  const std::vector<Items> parts = pieces(items, [this](Items whole, std::size_t cut) {
    halveLarge(whole, cut);
    reportSplit(whole.size());
  });
  const auto index = static_cast<std::uint32_t>(tree_.nodes.size());
  tree_.nodes.push_back(emptyNode());
  for (std::size_t lane = 0; lane < parts.size(); ++lane) {
    putOff.push_back({index, lane, parts[lane], {}, {}});
    if (parts[lane].size() <= kLargePart) continue;
    const std::uint32_t child = buildLarge(parts[lane], putOff);
    tree_.nodes[index].child[lane] = child;
  }
  return index;
}

void NormalConeTreeBuilder::buildSubtree(Subtree& subtree) const {
  SubtreeBuilder builder(*geometry_, tree_.size);
  for (const Item& item : subtree.items)
    builder.add(item.feature, item.centre, leafChild(item.feature));
  builder.build(subtree.bound, subtree.nodes);
}

}  // namespace nearfit
