#include "tests/exact/pose_certifier.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include <glm/geometric.hpp>

#include "core/parallel/parallel_for.h"
#include "tests/exact/box_tree.h"
#include "tests/exact/exact_meeting.h"
#include "tests/exact/triangle_separation.h"

namespace nearfit::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// What placing a point and measuring a gap may round, of the largest coordinate: a hundred roundings.
constexpr double kPlacementRounding = 1e-14;

Kernel::Point_3 toPoint(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Whether one triangle surely lies wholly on one side of the other's plane: by far more than rounding.
bool isSurelyBeside(const Corners& plane, const Corners& t) {
  constexpr double kFewRoundings = 1e-13;
  const glm::dvec3 u = plane[1] - plane[0], v = plane[2] - plane[0], n = glm::cross(u, v);
  int above = 0, below = 0;
  for (const glm::dvec3& p : t) {
    const glm::dvec3 w = p - plane[0];
    const double height = glm::dot(n, w), rounding = kFewRoundings * largest(u) * largest(v) * largest(w);
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
  struct NodePair {
    std::uint32_t scene, part;
  };

  Bodies(const TriangleMesh& s, const TriangleMesh& p)
      : scene(s), part(p), scenePieces(oneVertexAPiece(s)), partPieces(oneVertexAPiece(p)) {}

  std::vector<glm::dvec3> placed(const RigidTransform& pose) const {
    std::vector<glm::dvec3> out;
    for (const glm::dvec3& p : part.mesh().vertices())
      out.push_back(pose.applyToPoint(p));
    return out;
  }

  bool doSurfacesMeet(const RigidTransform& pose) const {
    if (scene.isEmpty() || part.isEmpty()) return false;
    const std::vector<glm::dvec3> vertices = placed(pose);
    const std::vector<Box> boxes = part.boxesAround(vertices);
    std::vector<NodePair> waiting{{0, 0}};
    while (!waiting.empty()) {
      const NodePair at = waiting.back();
      waiting.pop_back();
      const BoxTree::Node &a = scene.node(at.scene), &b = part.node(at.part);
      if (!a.box.meets(boxes[at.part])) continue;
      if (a.child == 0 && b.child == 0) {
        if (doLeavesMeet(a, b, vertices)) return true;
      } else {
        for (const NodePair& next : opened(at, boxes))
          waiting.push_back(next);
      }
    }
    return false;
  }

  double surfacesApart(const RigidTransform& pose, double most) const {
    if (scene.isEmpty() || part.isEmpty()) return most;
    const std::vector<glm::dvec3> vertices = placed(pose);
    const std::vector<Box> boxes = part.boxesAround(vertices);
    double apart = most;
    std::vector<NodePair> waiting{{0, 0}};
    while (!waiting.empty() && apart > 0.0) {
      const NodePair at = waiting.back();
      waiting.pop_back();
      const BoxTree::Node &a = scene.node(at.scene), &b = part.node(at.part);
      if (a.box.distance(boxes[at.part]) >= apart) continue;
      if (a.child == 0 && b.child == 0) {
        apart = std::min(apart, leavesApart(a, b, vertices, apart));
        continue;
      }
      std::array<NodePair, 2> next = opened(at, boxes);
      // The nearer one first: what it gives spares the other.
      const auto distance = [&](const NodePair& pair) {
        return scene.node(pair.scene).box.distance(boxes[pair.part]);
      };
      if (distance(next[0]) < distance(next[1])) std::swap(next[0], next[1]);
      waiting.insert(waiting.end(), next.begin(), next.end());
    }
    const double size = std::max({extent(scene.node(0).box), extent(part.node(0).box), extent(boxes[0])});
    return std::max(0.0, apart - kPlacementRounding * size);
  }

  double leavesApart(const BoxTree::Node& a, const BoxTree::Node& b, std::span<const glm::dvec3> vertices,
                     double most) const {
    for (const std::uint32_t p : part.triangles(b)) {
      for (const std::uint32_t s : scene.triangles(a))
        most = std::min(most, separation(scene.corners(s), part.corners(p, vertices), most));
    }
    return most;
  }

  /// The corners of the box around a part that has triangles, where the pose puts them.
  std::array<glm::dvec3, 8> placedCorners(const RigidTransform& pose) const {
    const Box& box = part.node(0).box;
    std::array<glm::dvec3, 8> out;
    for (unsigned corner = 0; corner < out.size(); ++corner) {
      out[corner] =
          pose.applyToPoint({(corner & 1U ? box.upper : box.lower).x, (corner & 2U ? box.upper : box.lower).y,
                             (corner & 4U ? box.upper : box.lower).z});
    }
    return out;
  }

  /// No vertex is farther from where the other pose has it: how far one is moved is convex over space.
  double motion(const RigidTransform& from, const RigidTransform& to) const {
    if (part.isEmpty()) return 0.0;
    const std::array<glm::dvec3, 8> before = placedCorners(from), after = placedCorners(to);
    double most = 0.0, size = extent(part.node(0).box);
    for (std::size_t i = 0; i < before.size(); ++i) {
      most = std::max(most, glm::distance(before[i], after[i]));
      size = std::max({size, largest(before[i]), largest(after[i])});
    }
    return most + kPlacementRounding * size;
  }

  /// No more than the distance of the surfaces: that of the boxes around the scene and the placed corners [m]. Bodies with
  /// disjoint boxes neither meet nor contain each other.
  double boxesApart(const RigidTransform& pose) const {
    if (scene.isEmpty() || part.isEmpty()) return std::numeric_limits<double>::infinity();
    Box placed;
    for (const glm::dvec3& p : placedCorners(pose))
      placed.add(p);
    const double size = std::max({extent(scene.node(0).box), extent(part.node(0).box), extent(placed)});
    return std::max(0.0, scene.node(0).box.distance(placed) - kPlacementRounding * size);
  }

  bool isOneInside(const RigidTransform& pose) const {
    const RigidTransform partFromScene = pose.inverse();
    return std::ranges::any_of(partPieces,
                               [&](const glm::dvec3& p) { return isInside(scene, pose.applyToPoint(p)); }) ||
           std::ranges::any_of(scenePieces, [&](const glm::dvec3& p) {
             return isInside(part, partFromScene.applyToPoint(p));
           });
  }

  bool doLeavesMeet(const BoxTree::Node& a, const BoxTree::Node& b,
                    std::span<const glm::dvec3> placed) const {
    for (const std::uint32_t p : part.triangles(b)) {
      const Corners q = part.corners(p, placed);
      const Box box = boxAround(q);
      if (!a.box.meets(box)) continue;
      for (const std::uint32_t s : scene.triangles(a)) {
        const Corners c = scene.corners(s);
        if (box.meets(boxAround(c)) && doMeetByCgal(c, q)) return true;
      }
    }
    return false;
  }

  static double extent(const Box& box) { return std::max(largest(box.lower), largest(box.upper)); }

  /// The larger node's children with the other.
  std::array<NodePair, 2> opened(const NodePair& at, std::span<const Box> boxes) const {
    const BoxTree::Node &a = scene.node(at.scene), &b = part.node(at.part);
    if (b.child == 0 || (a.child != 0 && a.box.size() >= boxes[at.part].size()))
      return {NodePair{a.child, at.part}, NodePair{a.child + 1, at.part}};
    return {NodePair{at.scene, b.child}, NodePair{at.scene, b.child + 1}};
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
  return bodies_->doSurfacesMeet(sceneFromPart) || bodies_->isOneInside(sceneFromPart);
}

double PoseCertifier::surfacesApart(const RigidTransform& sceneFromPart, double most) const {
  return bodies_->surfacesApart(sceneFromPart, most);
}

/// Looks at the poses of a way one after the other.
class PoseCertifier::Follower {
 public:
  Follower(const PoseCertifier& certifier, std::span<const RigidTransform> way)
      : certifier_(certifier), way_(way) {}

  bool doMeet(std::size_t i) {
    if (i > 0 && way_[i] == way_[i - 1]) return last_;
    // On the straight way of each vertex to where it is now no point of the surface comes as far as to the
    // other: neither do they meet now, nor has one come into the other.
    if (isApart_ && motion(anchor_, i) < apart_) return last_ = false;
    isApart_ = false;
    if (const double apart = certifier_.bodies_->boxesApart(way_[i]); apart > 0.0) {
      ++boxed;
      anchor_ = i;
      apart_ = apart;
      isApart_ = true;
      return last_ = false;
    }
    if (isWorthMeasuring(i)) {
      anchor_ = i;
      apart_ = found_ = certifier_.surfacesApart(way_[i], farthestAhead(i));
      if (apart_ > 0.0) {
        ++measured;
        last_ = certifier_.bodies_->isOneInside(way_[i]);
        isApart_ = !last_;
        return last_;
      }
    }
    ++tested;
    return last_ = certifier_.doMeet(way_[i]);
  }

  std::size_t tested = 0, measured = 0, boxed = 0;  ///< See WayVerdicts.

 private:
  static constexpr std::size_t kAhead = 256, kPatience = 8;

  double motion(std::size_t from, std::size_t to) const {
    return certifier_.bodies_->motion(way_[from], way_[to]);
  }
  /// It costs more than looking whether they meet: only where the next pose is likely to be spared.
  bool isWorthMeasuring(std::size_t i) {
    if (i + 1 >= way_.size()) return false;
    if (motion(i, i + 1) >= found_ && ++waited_ < kPatience) return false;
    waited_ = 0;
    return true;
  }
  /// No wider gap is of use. Some of the poses ahead tell: it only says how far to look.
  double farthestAhead(std::size_t i) const {
    double most = 0.0;
    for (std::size_t ahead = 1; ahead <= kAhead && i + ahead < way_.size(); ahead *= 2)
      most = std::max(most, motion(i, i + ahead));
    constexpr double kMore = 1.01;
    return kMore * most;
  }

  const PoseCertifier& certifier_;
  std::span<const RigidTransform> way_;
  std::size_t anchor_ = 0, waited_ = 0;
  double apart_ = 0.0;
  double found_ = std::numeric_limits<double>::infinity();  ///< When last measured.
  bool isApart_ = false;  ///< By `apart_`, at the anchor, and neither is in the other.
  bool last_ = false;
};

WayVerdicts PoseCertifier::along(std::span<const RigidTransform> sceneFromPart) const {
  constexpr std::size_t kBlock = 256;
  WayVerdicts out;
  out.meetings.assign(sceneFromPart.size(), 0);
  std::atomic<std::size_t> tested = 0, measured = 0, boxed = 0;
  parallelFor((out.meetings.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    const std::size_t first = block * kBlock, count = std::min(kBlock, out.meetings.size() - first);
    Follower follower(*this, sceneFromPart.subspan(first, count));
    for (std::size_t i = 0; i < count; ++i)
      out.meetings[first + i] = follower.doMeet(i) ? 1 : 0;
    tested += follower.tested;
    measured += follower.measured;
    boxed += follower.boxed;
  });
  out.tested = tested;
  out.measured = measured;
  out.boxed = boxed;
  return out;
}

std::vector<char> PoseCertifier::meetings(std::span<const RigidTransform> sceneFromPart) const {
  return along(sceneFromPart).meetings;
}

}  // namespace nearfit::test
