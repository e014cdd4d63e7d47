#include "tests/exact/pose_certifier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include "core/parallel/parallel_for.h"
#include "tests/exact/exact_meeting.h"

namespace nearfit::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Corners = std::array<glm::dvec3, 3>;

struct Box {
  glm::dvec3 lower{INFINITY}, upper{-INFINITY};
  void add(const glm::dvec3& p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  bool meets(const Box& other) const {
    for (glm::length_t i = 0; i < 3; ++i) {
      if (lower[i] > other.upper[i] || other.lower[i] > upper[i]) return false;
    }
    return true;
  }
  double size() const { return upper.x - lower.x + upper.y - lower.y + upper.z - lower.z; }
};

Box around(const Corners& corners) {
  Box box;
  for (const glm::dvec3& p : corners)
    box.add(p);
  return box;
}

/// Boxes over a mesh's triangles, halved along the longest side until a few are left.
class BoxTree {
 public:
  struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;  ///< Of order(), where there are no children.
    std::uint32_t child = 0;             ///< The first of two beside each other; 0: none.
  };

  explicit BoxTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles().size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    nodes_.emplace_back();
    if (!order_.empty()) build(0, 0, static_cast<std::uint32_t>(order_.size()));
  }

  const TriangleMesh& mesh() const { return mesh_; }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  std::span<const std::uint32_t> triangles(const Node& n) const {
    return std::span(order_).subspan(n.first, n.count);
  }
  bool isEmpty() const { return order_.empty(); }
  Corners corners(std::uint32_t triangle) const { return corners(triangle, mesh_.vertices()); }
  Corners corners(std::uint32_t triangle, std::span<const glm::dvec3> vertices) const {
    const Triangle& t = mesh_.triangles()[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
  /// By node, around the same triangles with their vertices elsewhere.
  std::vector<Box> boxesAround(std::span<const glm::dvec3> vertices) const {
    std::vector<Box> boxes(nodes_.size());
    // Children stand behind their parents.
    for (std::size_t i = nodes_.size(); i-- > 0;) {
      const Node& n = nodes_[i];
      if (n.child != 0) {
        boxes[i] = boxes[n.child];
        boxes[i].add(boxes[n.child + 1].lower);
        boxes[i].add(boxes[n.child + 1].upper);
        continue;
      }
      for (const std::uint32_t t : triangles(n)) {
        for (const glm::dvec3& p : corners(t, vertices))
          boxes[i].add(p);
      }
    }
    return boxes;
  }

 private:
  void build(std::uint32_t index, std::uint32_t first, std::uint32_t count) {
    constexpr std::uint32_t kFew = 1;
    Box box;
    for (std::uint32_t i = first; i < first + count; ++i) {
      for (const glm::dvec3& p : corners(order_[i]))
        box.add(p);
    }
    nodes_[index] = {box, first, count, 0};
    if (count <= kFew) return;
    const glm::dvec3 d = box.upper - box.lower;
    const glm::length_t axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    const auto key = [&](std::uint32_t t) {
      const Corners c = corners(t);
      return c[0][axis] + c[1][axis] + c[2][axis];
    };
    const std::uint32_t half = count / 2;
    std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                     [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[index].child = child;
    nodes_.resize(nodes_.size() + 2);
    build(child, first, half);
    build(child + 1, first + half, count - half);
  }

  TriangleMesh mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

Kernel::Point_3 toPoint(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Whether one triangle surely lies wholly on one side of the other's plane: by far more than rounding.
bool isSurelyBeside(const Corners& plane, const Corners& t) {
  constexpr double kRounding = 1e-13;
  const glm::dvec3 u = plane[1] - plane[0], v = plane[2] - plane[0], n = glm::cross(u, v);
  int above = 0, below = 0;
  for (const glm::dvec3& p : t) {
    const glm::dvec3 w = p - plane[0];
    const double height = glm::dot(n, w), rounding = kRounding * largest(u) * largest(v) * largest(w);
    above += height > rounding ? 1 : 0;
    below += height < -rounding ? 1 : 0;
  }
  return above == 3 || below == 3;
}

bool doMeetByCgal(const Corners& a, const Corners& b) {
  if (isSurelyBeside(a, b) || isSurelyBeside(b, a)) return false;
  const Kernel::Triangle_3 s(toPoint(a[0]), toPoint(a[1]), toPoint(a[2]));
  const Kernel::Triangle_3 t(toPoint(b[0]), toPoint(b[1]), toPoint(b[2]));
  // Those of no area are rare: the slow way takes them.
  if (s.is_degenerate() || t.is_degenerate()) return doMeetExactly(a, b);
  return CGAL::do_intersect(s, t);
}

/// One vertex of each set of triangles that hang together.
std::vector<glm::dvec3> oneVertexAPiece(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices().size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v)
      v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles())
    parent[root(t[0])] = parent[root(t[1])] = root(t[2]);
  std::vector<glm::dvec3> out;
  std::vector<bool> isUsed(parent.size(), false);
  for (const Triangle& t : mesh.triangles())
    isUsed[root(t[0])] = true;
  for (std::uint32_t v = 0; v < parent.size(); ++v) {
    if (isUsed[v]) out.push_back(mesh.vertices()[v]);
  }
  return out;
}

}  // namespace

struct PoseCertifier::Bodies {
  Bodies(const TriangleMesh& s, const TriangleMesh& p)
      : scene(s), part(p), scenePieces(oneVertexAPiece(s)), partPieces(oneVertexAPiece(p)) {}

  bool doSurfacesMeet(const RigidTransform& pose) const {
    if (scene.isEmpty() || part.isEmpty()) return false;
    std::vector<glm::dvec3> placed;
    for (const glm::dvec3& p : part.mesh().vertices())
      placed.push_back(pose.applyToPoint(p));
    const std::vector<Box> boxes = part.boxesAround(placed);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> waiting{{0, 0}};
    while (!waiting.empty()) {
      const auto [s, p] = waiting.back();
      waiting.pop_back();
      const BoxTree::Node &a = scene.node(s), &b = part.node(p);
      if (!a.box.meets(boxes[p])) continue;
      if (a.child == 0 && b.child == 0) {
        if (doLeavesMeet(a, b, placed)) return true;
      } else if (b.child == 0 || (a.child != 0 && a.box.size() >= boxes[p].size())) {
        waiting.emplace_back(a.child, p);
        waiting.emplace_back(a.child + 1, p);
      } else {
        waiting.emplace_back(s, b.child);
        waiting.emplace_back(s, b.child + 1);
      }
    }
    return false;
  }

  bool doLeavesMeet(const BoxTree::Node& a, const BoxTree::Node& b,
                    std::span<const glm::dvec3> placed) const {
    for (const std::uint32_t p : part.triangles(b)) {
      const Corners q = part.corners(p, placed);
      const Box box = around(q);
      if (!a.box.meets(box)) continue;
      for (const std::uint32_t s : scene.triangles(a)) {
        const Corners c = scene.corners(s);
        if (box.meets(around(c)) && doMeetByCgal(c, q)) return true;
      }
    }
    return false;
  }

  static bool isInside(const BoxTree& solid, const glm::dvec3& point) {
    if (solid.isEmpty() || !solid.node(0).box.meets({point, point})) return false;
    const MeshTopology& topology = solid.mesh().topology();
    return topology.isClosed() && topology.isOriented() && std::abs(windingNumber(solid.mesh(), point)) > 0.5;
  }

  BoxTree scene, part;
  std::vector<glm::dvec3> scenePieces, partPieces;
};

PoseCertifier::PoseCertifier(const TriangleMesh& scene, const TriangleMesh& part)
    : bodies_(std::make_unique<const Bodies>(scene, part)) {}
PoseCertifier::~PoseCertifier() = default;
PoseCertifier::PoseCertifier(PoseCertifier&&) noexcept = default;

bool PoseCertifier::doMeet(const RigidTransform& sceneFromPart) const {
  const Bodies& b = *bodies_;
  if (b.doSurfacesMeet(sceneFromPart)) return true;
  const RigidTransform partFromScene = sceneFromPart.inverse();
  return std::ranges::any_of(
             b.partPieces,
             [&](const glm::dvec3& p) { return Bodies::isInside(b.scene, sceneFromPart.applyToPoint(p)); }) ||
         std::ranges::any_of(b.scenePieces, [&](const glm::dvec3& p) {
           return Bodies::isInside(b.part, partFromScene.applyToPoint(p));
         });
}

std::vector<char> PoseCertifier::meetings(std::span<const RigidTransform> sceneFromPart) const {
  std::vector<char> out(sceneFromPart.size(), 0);
  parallelFor(out.size(), [&](std::size_t i) { out[i] = doMeet(sceneFromPart[i]) ? 1 : 0; });
  return out;
}

}  // namespace nearfit::test
