#include "core/proximity/normal_cone_tree_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/error.h"
#include "core/math/symmetric_eigen.h"
#include "core/parallel/parallel_for.h"

namespace nearfit {
namespace {

/// Added to each half extent as a fraction of the mesh's size: ten roundings of a single precision
/// coordinate.
constexpr double kExtentPadding = 1e-6;

/// Added to each limit on directions: some roundings of a single precision axis.
constexpr double kDirectionPadding = 2e-6;

/// Parts larger than this are opened whatever they hold: they get no exact limits of direction, and are split
/// along their widest axis untried.
constexpr std::size_t kLargePart = 4096;

/// Shares of the time that building takes, about, for the report of progress: looking for features, splitting
/// what one thread splits, and building the rest on all processors.
constexpr double kFeaturesShare = 0.3, kSplitsShare = 0.2, kSubtreesShare = 0.5;

constexpr std::size_t kWidth = NormalConeTree::kWidth;

std::array<float, 3> toSingle(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// How many features a child of a node over `count` features holds when it is full: the least power of eight
/// that eight children need.
std::size_t fullChild(std::size_t count) {
  std::size_t size = 1;
  while (size * kWidth < count)
    size *= kWidth;
  return size;
}

}  // namespace

NormalConeTree::Arrays NormalConeTreeBuilder::build() {
  constexpr std::size_t kMaxLeaves = (std::size_t{1} << 29) - 1;
  if (mesh_.edges().size() > kMaxLeaves) {
    throw Error("mesh", "it has more edges than the hierarchy can name", "decimate it first");
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
          {mesh_.vertices().size(), mesh_.edges().size(), mesh_.triangles().size()},
          std::move(tree_.nodes),
          std::move(tree_.positions),
          std::move(tree_.vertices),
          std::move(tree_.edges),
          std::move(tree_.faces),
          std::move(features_.neighbours)};
}

void NormalConeTreeBuilder::findFeaturesOfMesh() {
  double reported = 0.0;
  features_ = findFeatures(mesh_, [&](double fraction) {
    progress_.add(kFeaturesShare * (fraction - reported));
    reported = fraction;
  });
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
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    const FeatureGeometry::Corners c = geometry_->corners(i);
    Aabb box;
    for (std::size_t k = 0; k < c.count; ++k)
      box.add(c.points[k]);
    items[i].centre = toSingle(box.centre());
    items[i].feature = i;
  }
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
  tree_.nodes.emplace_back();
  for (std::size_t lane = 0; lane < kWidth; ++lane)
    setLane(tree_.nodes[0], lane, lane == 0 ? items : Items{});
  std::vector<Subtree> subtrees;
  const std::uint32_t child =
      items.size() == 1 ? leafChild(items[0].feature) : buildNode(items, tree_.nodes, &subtrees);
  tree_.nodes[0].child[0] = child;
  buildSubtrees(subtrees);
}

/// Builds what was put off, on all processors; the same tree whoever builds which part.
void NormalConeTreeBuilder::buildSubtrees(std::vector<Subtree>& subtrees) {
  parallelFor(subtrees.size(), [&](std::size_t i) {
    Subtree& subtree = subtrees[i];
    buildNode(subtree.items, subtree.nodes, nullptr);
    progress_.add(kSubtreesShare * static_cast<double>(subtree.items.size()) /
                  static_cast<double>(geometry_->size()));
  });

  for (Subtree& subtree : subtrees) {
    const auto offset = static_cast<std::uint32_t>(tree_.nodes.size());
    for (NormalConeTree::Node& node : subtree.nodes) {
      for (std::uint32_t& child : node.child)
        child += NormalConeTree::isLeaf(child) ? 0 : offset;
    }
    tree_.nodes[subtree.parent].child[subtree.lane] = offset;
    tree_.nodes.insert(tree_.nodes.end(), subtree.nodes.begin(), subtree.nodes.end());
    subtree.nodes = {};
  }
}

/// Orders the items so that the first `cut` are lowest along an axis.
void NormalConeTreeBuilder::partition(Items items, std::size_t cut, std::size_t axis) {
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(cut), items.end(),
                   [axis](const Item& a, const Item& b) {
                     return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis]
                                                             : a.feature < b.feature;
                   });
}

/// Number of features times the diagonal of their box: what a part costs a query, roughly.
double NormalConeTreeBuilder::cost(Items items) const {
  Aabb box;
  for (const Item& item : items) {
    const FeatureGeometry::Corners c = geometry_->corners(item.feature);
    for (std::size_t k = 0; k < c.count; ++k)
      box.add(c.points[k]);
  }
  return static_cast<double>(items.size()) * box.diagonal();
}

/// Halves the items, the first part a multiple of `unit`, along the axis that leaves the cheaper parts;
/// returns its size. Normals have no say: splits that weigh them were measured to make queries slower, as
/// they make parts wider.
std::size_t NormalConeTreeBuilder::split(Items items, std::size_t unit) const {
  const std::size_t cut = std::max<std::size_t>(1, (items.size() / 2 + unit / 2) / unit) * unit;
  std::size_t best = 0, last = 0;
  if (items.size() > kLargePart) {
    Aabb box;
    for (const Item& item : items)
      box.add({item.centre[0], item.centre[1], item.centre[2]});
    const glm::dvec3 width = box.upper - box.lower;
    best = width.x >= width.y && width.x >= width.z ? 0 : width.y >= width.z ? 1 : 2;
    last = 3;
  } else {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      partition(items, cut, axis);
      const double parts = cost(items.first(cut)) + cost(items.subspan(cut));
      if (parts < least) {
        least = parts;
        best = axis;
      }
      last = axis;
    }
  }
  if (last != best) partition(items, cut, best);
  return cut;
}

/// Counts a split that one thread makes for all, as a part of the halvings of everything down to what is put
/// off.
void NormalConeTreeBuilder::reportSplit(std::size_t items) {
  const auto all = static_cast<double>(geometry_->size());
  const double halvings = std::max(1.0, std::log2(all / static_cast<double>(kLargePart)));
  progress_.add(kSplitsShare * static_cast<double>(items) / (all * halvings));
}

/// Returns the index of a new node over the items.
/// @param putOff  Where to leave subtrees that are small enough to be built by one thread; null: none is
/// left.
std::uint32_t NormalConeTreeBuilder::buildNode(Items items, std::vector<NormalConeTree::Node>& nodes,
                                               std::vector<Subtree>* putOff) {
  const std::size_t full = fullChild(items.size());
  std::array<Items, kWidth> parts{items};
  std::size_t count = 1;
  for (;;) {
    Items& largest = *std::max_element(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count),
                                       [](const Items& a, const Items& b) { return a.size() < b.size(); });
    if (largest.size() <= full || count == kWidth) break;
    const std::size_t cut = split(largest, full);
    if (putOff != nullptr) reportSplit(largest.size());
    parts[count++] = largest.subspan(cut);
    largest = largest.first(cut);
  }

  const auto index = static_cast<std::uint32_t>(nodes.size());
  nodes.emplace_back();
  for (std::size_t lane = 0; lane < kWidth; ++lane)
    setLane(nodes[index], lane, parts[lane]);
  for (std::size_t lane = 0; lane < count; ++lane) {
    if (parts[lane].size() == 1) {
      nodes[index].child[lane] = leafChild(parts[lane][0].feature);
    } else if (putOff != nullptr && parts[lane].size() <= kLargePart) {
      putOff->push_back({index, lane, parts[lane], {}});
    } else {
      const std::uint32_t child = buildNode(parts[lane], nodes, putOff);
      nodes[index].child[lane] = child;
    }
  }
  return index;
}

void NormalConeTreeBuilder::setLane(NormalConeTree::Node& node, std::size_t lane, Items items) const {
  NormalConeTree::Bound b{};
  if (items.empty()) {
    b.centre.fill(NormalConeTree::kOutOfReach);
    b.n = {1.0F, 0.0F, 0.0F};
    b.u = {0.0F, 1.0F, 0.0F};
  } else {
    b = bound(items);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    node.centre[k][lane] = b.centre[k];
    node.n[k][lane] = b.n[k];
    node.u[k][lane] = b.u[k];
    node.half[k][lane] = b.half[k];
  }
  node.leastN[lane] = b.leastN;
  node.mostU[lane] = b.mostU;
  node.mostV[lane] = b.mostV;
  node.child[lane] = NormalConeTree::kNoChild;
}

/// n along the axis of the feature's cone, u along its longest side.
std::array<glm::dvec3, 3> NormalConeTreeBuilder::axesOfOne(std::uint32_t feature) const {
  const glm::dvec3 n = geometry_->cone(feature).axis;
  const FeatureGeometry::Corners c = geometry_->corners(feature);
  glm::dvec3 side(0.0);
  for (std::size_t k = 0; k < c.count; ++k) {
    const glm::dvec3 s = c.points[(k + 1) % c.count] - c.points[k];
    if (glm::dot(s, s) > glm::dot(side, side)) side = s;
  }
  side -= glm::dot(side, n) * n;
  const double length = glm::length(side);
  if (!(length > 0.0)) side = std::abs(n.x) < 0.5 ? glm::dvec3(0.0, n.z, -n.y) : glm::dvec3(-n.z, 0.0, n.x);
  const glm::dvec3 u = glm::normalize(side);
  return {n, u, glm::cross(n, u)};
}

/// u where the features are long and their normals are not, n along the mean normal, v square to both.
std::array<glm::dvec3, 3> NormalConeTreeBuilder::axes(Items items) const {
  if (items.size() == 1) return axesOfOne(items[0].feature);
  glm::dmat3 positions(0.0), normals(0.0);
  glm::dvec3 mean(0.0), meanNormal(0.0);
  double points = 0.0;
  for (const Item& item : items) {
    const FeatureGeometry::Corners c = geometry_->corners(item.feature);
    for (std::size_t k = 0; k < c.count; ++k) {
      mean += c.points[k];
      positions += glm::outerProduct(c.points[k], c.points[k]);
      points += 1.0;
    }
    const NormalCone& cone = geometry_->cone(item.feature);
    meanNormal += cone.axis;
    // An arc spreads across its edge too, a wide cone about its axis.
    normals += glm::outerProduct(cone.axis, cone.axis);
    if (item.feature >= geometry_->edgeBase() && item.feature < geometry_->faceBase()) {
      const glm::dvec3 across = glm::normalize(glm::cross(cone.axis, c.points[1] - c.points[0]));
      normals += std::sin(cone.halfAngle) * glm::outerProduct(across, across);
    }
  }
  mean /= points;
  positions = positions / points - glm::outerProduct(mean, mean);
  const auto trace = [](const glm::dmat3& m) { return m[0][0] + m[1][1] + m[2][2]; };
  const double spread = trace(positions), least = 1e-30 * tree_.size * tree_.size;
  glm::dmat3 shape = normals / -trace(normals);
  if (spread > least) shape += positions / spread;
  const SymmetricEigen eigen = symmetricEigen(shape);
  const glm::dvec3 u = eigen.vectors[2];
  glm::dvec3 n = meanNormal - glm::dot(meanNormal, u) * u;
  const double length = glm::length(n);
  constexpr double kNoMean = 1e-3;
  n = length > kNoMean * static_cast<double>(items.size()) ? n / length : eigen.vectors[0];
  return {n, u, glm::cross(n, u)};
}

NormalConeTree::Bound NormalConeTreeBuilder::bound(Items items) const {
  const std::array<glm::dvec3, 3> frame = axes(items);
  glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
  double leastN = 1.0, mostU = 0.0, mostV = 0.0;
  for (const Item& item : items) {
    const FeatureGeometry::Corners c = geometry_->corners(item.feature);
    for (std::size_t k = 0; k < c.count; ++k) {
      const glm::dvec3 p(glm::dot(c.points[k], frame[0]), glm::dot(c.points[k], frame[1]),
                         glm::dot(c.points[k], frame[2]));
      lower = glm::min(lower, p);
      upper = glm::max(upper, p);
    }
    if (items.size() > kLargePart) continue;
    if (leastN > -1.0) leastN = std::min(leastN, -geometry_->support(item.feature, -frame[0]));
    if (mostU < 1.0)
      mostU = std::max(
          {mostU, geometry_->support(item.feature, frame[1]), geometry_->support(item.feature, -frame[1])});
    if (mostV < 1.0)
      mostV = std::max(
          {mostV, geometry_->support(item.feature, frame[2]), geometry_->support(item.feature, -frame[2])});
  }
  if (items.size() > kLargePart) {
    leastN = -1.0;
    mostU = mostV = 1.0;
  }
  const glm::dvec3 middle = 0.5 * (lower + upper);
  const glm::dvec3 half = 0.5 * (upper - lower) + kExtentPadding * tree_.size;
  NormalConeTree::Bound b{};
  b.centre = toSingle(middle.x * frame[0] + middle.y * frame[1] + middle.z * frame[2]);
  b.n = toSingle(frame[0]);
  b.u = toSingle(frame[1]);
  b.v = toSingle(frame[2]);
  b.half = toSingle(half);
  b.leastN = static_cast<float>(leastN - kDirectionPadding);
  b.mostU = static_cast<float>(mostU + kDirectionPadding);
  b.mostV = static_cast<float>(mostV + kDirectionPadding);
  return b;
}

}  // namespace nearfit
