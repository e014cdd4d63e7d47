#include "core/proximity/normal_cone_tree.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/math/normal_cone.h"
#include "core/mesh/features.h"

namespace nearfit {
namespace {

/// Added to each radius as a fraction of the mesh's size: ten roundings of a single precision coordinate.
constexpr double kRadiusPadding = 1e-6;

/// Added to each half-angle [rad]: rounding of a single precision axis.
constexpr double kAnglePadding = 1e-6;

/// One feature on its way into the tree.
struct Item {
  glm::dvec3 centre;
  double radius;
  NormalCone cone;
  std::uint32_t child;
};

std::uint32_t leafChild(FeatureKind kind, std::size_t index) {
  return NormalConeTree::kLeafBit | static_cast<std::uint32_t>(kind) << 29 |
         static_cast<std::uint32_t>(index);
}

}  // namespace

/// Median splits, three at a time, until each feature stands alone.
class NormalConeTreeBuilder {
 public:
  NormalConeTreeBuilder(NormalConeTree& tree, const TriangleMesh& mesh) : tree_(tree), mesh_(mesh) {}

  void build() {
    constexpr std::size_t kMaxLeaves = std::size_t{1} << 29;
    if (mesh_.edges().size() >= kMaxLeaves) {
      throw Error("mesh", "it has more edges than the hierarchy can name", "decimate it first");
    }
    tree_.centre_ = mesh_.bounds().isEmpty() ? glm::dvec3(0.0) : mesh_.bounds().centre();
    tree_.size_ = mesh_.bounds().diagonal();
    tree_.all_ = {mesh_.vertices().size(), mesh_.edges().size(), mesh_.triangles().size()};
    tree_.positions_.reserve(mesh_.vertices().size());
    for (const glm::dvec3& p : mesh_.vertices())
      tree_.positions_.push_back(p - tree_.centre_);
    collectItems();
    if (items_.empty()) return;
    tree_.root_ = bound(items_);
    buildNode(items_);
  }

 private:
  using Items = std::span<Item>;

  void collectItems() {
    MeshFeatures features = findFeatures(mesh_);
    items_.reserve(features.vertices.size() + features.edges.size() + features.faces.size());
    const auto& x = tree_.positions_;
    for (const VertexFeature& f : features.vertices) {
      items_.push_back({x[f.vertex], 0.0, f.cone, leafChild(FeatureKind::Vertex, tree_.vertices_.size())});
      tree_.vertices_.push_back({f.vertex, f.firstNeighbour, f.neighbourCount});
    }
    for (const EdgeFeature& f : features.edges) {
      const MeshEdge& e = mesh_.edges()[f.edge];
      items_.push_back({0.5 * (x[e.v0] + x[e.v1]), 0.5 * glm::distance(x[e.v0], x[e.v1]), f.cone,
                        leafChild(FeatureKind::Edge, tree_.edges_.size())});
      tree_.edges_.push_back({f.edge, e.v0, e.v1, f.opposite});
    }
    for (const FaceFeature& f : features.faces) {
      const Triangle& t = mesh_.triangles()[f.face];
      const auto [centre, radius] = triangleSphere(x[t[0]], x[t[1]], x[t[2]]);
      items_.push_back({centre, radius, f.cone, leafChild(FeatureKind::Face, tree_.faces_.size())});
      tree_.faces_.push_back({f.face, t});
    }
    tree_.neighbours_ = std::move(features.neighbours);
  }

  /// Smallest enclosing sphere of a triangle: on its longest side if the angle there is obtuse, else
  /// circumscribed.
  static std::pair<glm::dvec3, double> triangleSphere(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const auto side = [](const glm::dvec3& p, const glm::dvec3& q) { return glm::dot(p - q, p - q); };
    if (side(b, c) > side(a, b)) std::swap(a, c);
    if (side(a, c) > side(a, b)) std::swap(b, c);
    const glm::dvec3 middle = 0.5 * (a + b);
    const glm::dvec3 ca = a - c, cb = b - c, normal = glm::cross(ca, cb);
    const double area = glm::dot(normal, normal);
    glm::dvec3 centre = middle;
    if (glm::dot(ca, cb) > 0.0 && area > 0.0) {
      centre = c + glm::cross(glm::dot(ca, ca) * cb - glm::dot(cb, cb) * ca, normal) / (2.0 * area);
      // A sliver's circumcentre is all rounding.
      if (!(side(centre, middle) < side(a, b))) centre = middle;
    }
    return {centre, std::sqrt(std::max({side(centre, a), side(centre, b), side(centre, c)}))};
  }

  NormalConeTree::Bound bound(Items items) {
    Aabb box;
    for (const Item& i : items) {
      box.add(i.centre - glm::dvec3(i.radius));
      box.add(i.centre + glm::dvec3(i.radius));
    }
    const glm::dvec3 centre = items.size() == 1 ? items[0].centre : box.centre();
    double radius = 0.0;
    cones_.clear();
    for (const Item& i : items) {
      radius = std::max(radius, glm::distance(centre, i.centre) + i.radius);
      cones_.push_back(i.cone);
    }
    NormalCone cone = items.size() == 1 ? items[0].cone : boundingCone(cones_);
    cone.halfAngle = std::min(cone.halfAngle + kAnglePadding, std::numbers::pi);
    radius += kRadiusPadding * tree_.size_;
    const auto f = [](double v) { return static_cast<float>(v); };
    return {f(centre.x),
            f(centre.y),
            f(centre.z),
            f(radius),
            f(cone.axis.x),
            f(cone.axis.y),
            f(cone.axis.z),
            f(std::cos(cone.halfAngle)),
            f(std::sin(cone.halfAngle))};
  }

  /// Halves at the median along the longest side of the centres' bounding box.
  static std::size_t split(Items items) {
    Aabb box;
    for (const Item& i : items)
      box.add(i.centre);
    const glm::dvec3 extent = box.upper - box.lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [axis](const Item& a, const Item& b) {
                       return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis]
                                                               : a.child < b.child;
                     });
    return half;
  }

  /// Fills a new node whose children share out the items; returns its index.
  std::uint32_t buildNode(Items items) {
    std::array<Items, NormalConeTree::kWidth> parts;
    parts[0] = items;
    std::size_t count = 1;
    while (count < NormalConeTree::kWidth) {
      const auto largest =
          std::max_element(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count),
                           [](const Items& a, const Items& b) { return a.size() < b.size(); });
      if (largest->size() < 2) break;
      const std::size_t half = split(*largest);
      parts[count++] = largest->subspan(half);
      *largest = largest->first(half);
    }

    const auto index = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.nodes_.emplace_back();
    for (std::size_t lane = 0; lane < count; ++lane) {
      const NormalConeTree::Bound b = bound(parts[lane]);
      const std::uint32_t child = parts[lane].size() == 1 ? parts[lane][0].child : buildNode(parts[lane]);
      store(tree_.nodes_[index], lane, b, child);
    }
    // Unused lanes repeat the last one, so that arithmetic on them stays finite; no one reads the result.
    NormalConeTree::Node& node = tree_.nodes_[index];
    node.childCount = static_cast<std::uint32_t>(count);
    for (std::size_t lane = count; lane < NormalConeTree::kWidth; ++lane) {
      store(node, lane, node.bound(count - 1), node.child[count - 1]);
    }
    return index;
  }

  static void store(NormalConeTree::Node& node, std::size_t lane, const NormalConeTree::Bound& b,
                    std::uint32_t child) {
    node.x[lane] = b.x;
    node.y[lane] = b.y;
    node.z[lane] = b.z;
    node.radius[lane] = b.radius;
    node.axisX[lane] = b.axisX;
    node.axisY[lane] = b.axisY;
    node.axisZ[lane] = b.axisZ;
    node.cosAngle[lane] = b.cosAngle;
    node.sinAngle[lane] = b.sinAngle;
    node.child[lane] = child;
  }

  NormalConeTree& tree_;
  const TriangleMesh& mesh_;
  std::vector<Item> items_;
  std::vector<NormalCone> cones_;
};

NormalConeTree::NormalConeTree(const TriangleMesh& mesh) {
  NormalConeTreeBuilder(*this, mesh).build();
}

std::size_t NormalConeTree::byteSize() const noexcept {
  return nodes_.capacity() * sizeof(Node) + positions_.capacity() * sizeof(glm::dvec3) +
         vertices_.capacity() * sizeof(VertexLeaf) + edges_.capacity() * sizeof(EdgeLeaf) +
         faces_.capacity() * sizeof(FaceLeaf) + neighbours_.capacity() * sizeof(std::uint32_t);
}

}  // namespace nearfit
