#include "core/placing/straight_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/triangle_corners.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/surface/near_faces.h"

namespace nearfit {
namespace {

/// Max error of a node's single-precision box, as a fraction of its size: its axes are unit and
/// perpendicular to 1e-7.
constexpr double kBoxSlack = 1e-6;
/// Edges nearer to parallel than this have no reliable common normal [rad].
constexpr double kParallel = 1e-12;
/// Pairs of nodes between two calls of onWork.
constexpr std::uint64_t kBetweenCalls = 2048;

/// The range of a straight motion on which no tested axis separates two convex bodies.
struct SweepStretch {
  /// Travel along the direction [m].
  double from = 0.0, to = std::numeric_limits<double>::infinity();

  bool isEmpty() const noexcept { return from > to; }

  /// Removes the range on which an axis separates them.
  /// @param gap    From the fixed body's upper end on the axis to the moving one's lower end, at the start.
  /// @param depth  From the fixed body's lower end to the moving one's upper end.
  /// @param speed  Of the moving body along the axis.
  /// @return True if this axis now determines where they touch.
  bool cut(double gap, double depth, double speed) noexcept {
    if (speed == 0.0) {
      if (gap > 0.0 || depth < 0.0) to = -1.0;
      return false;
    }
    const double enter = speed < 0.0 ? -gap / speed : -depth / speed;
    const double leave = speed < 0.0 ? -depth / speed : -gap / speed;
    to = std::fmin(to, leave);
    if (!(enter > from)) return false;
    from = enter;
    return true;
  }
};

/// The first contact of two triangles in a straight motion.
struct SweepHit {
  double travel = 0.0;  ///< Along the direction; infinity if they never touch.
  /// Normal of the plane in which they touch, against the direction; unit. Zero if they touch at the start.
  glm::dvec3 normal{0.0};
};

struct Shadow {
  double lower, upper;
};
Shadow shadowOf(const TriangleCorners& corners, const glm::dvec3& axis) noexcept {
  const double a = glm::dot(corners[0], axis), b = glm::dot(corners[1], axis), c = glm::dot(corners[2], axis);
  return {std::min({a, b, c}), std::max({a, b, c})};
}

struct Edges {
  std::array<glm::dvec3, 3> edge;
  glm::dvec3 normal;  ///< Not unit.
};
Edges edgesOf(const TriangleCorners& t) noexcept {
  return {{t[1] - t[0], t[2] - t[1], t[0] - t[2]}, glm::cross(t[1] - t[0], t[2] - t[0])};
}

class Sweep {
 public:
  Sweep(const TriangleCorners& fixed, const TriangleCorners& moving, const glm::dvec3& direction,
        double within) noexcept
      : fixed_(fixed), moving_(moving), direction_(direction) {
    stretch_.to = within;
  }

  /// @param longest  Length that the axis would have if its factors were perpendicular.
  /// @return False once the triangles can never touch.
  bool look(const glm::dvec3& axis, double longest) noexcept {
    const double length = glm::length(axis);
    if (!(length > kParallel * longest)) return true;
    const glm::dvec3 unit = axis / length;
    const Shadow a = shadowOf(fixed_, unit), b = shadowOf(moving_, unit);
    const double speed = glm::dot(direction_, unit);
    if (stretch_.cut(b.lower - a.upper, b.upper - a.lower, speed)) normal_ = speed < 0.0 ? unit : -unit;
    return !stretch_.isEmpty();
  }

  SweepHit hit() const noexcept { return {stretch_.from, normal_}; }

 private:
  const TriangleCorners &fixed_, &moving_;
  glm::dvec3 direction_;
  SweepStretch stretch_;
  glm::dvec3 normal_{0.0};
};

bool lookAll(Sweep& sweep, const Edges& a, const Edges& b) noexcept {
  for (const Edges* t : {&a, &b}) {
    const double longest =
        std::max({glm::length(t->edge[0]), glm::length(t->edge[1]), glm::length(t->edge[2])});
    if (!sweep.look(t->normal, longest * longest)) return false;
    for (const glm::dvec3& edge : t->edge) {
      if (!sweep.look(glm::cross(t->normal, edge), glm::length(t->normal) * glm::length(edge))) return false;
    }
  }
  for (const glm::dvec3& e : a.edge) {
    for (const glm::dvec3& f : b.edge) {
      if (!sweep.look(glm::cross(e, f), glm::length(e) * glm::length(f))) return false;
    }
  }
  return true;
}

/// How far `moving` goes along `direction`, without rotation, until it touches `fixed`; 0 if they already
/// touch. A triangle is the convex hull of its corners; both sides count.
///
/// @param direction  Unit.
/// @param within     Max travel of interest; longer ones may be returned as infinity.
/// Before the returned travel the triangles are apart, up to rounding of the corners. If rounding alone
/// decides a grazing motion, they touch.
/// Exact separating axes of moving polytopes (S. Gottschalk's, in D. Eberly's dynamic form), including those
/// in the triangles' planes for parallel pairs.
SweepHit sweepTriangles(const TriangleCorners& fixed, const TriangleCorners& moving,
                        const glm::dvec3& direction, double within) noexcept {
  Sweep sweep(fixed, moving, direction, within);
  if (lookAll(sweep, edgesOf(fixed), edgesOf(moving))) return sweep.hit();
  return {std::numeric_limits<double>::infinity(), glm::dvec3(0.0)};
}

struct Box {
  glm::dvec3 centre{0.0};
  glm::dmat3 axes{1.0};  ///< Columns.
  glm::dvec3 half{0.0};
  double size() const noexcept { return half.x + half.y + half.z; }
};

double radiusAlong(const Box& box, const glm::dvec3& axis) noexcept {
  const glm::dvec3 along = axis * box.axes;
  return box.half.x * std::abs(along.x) + box.half.y * std::abs(along.y) + box.half.z * std::abs(along.z);
}

/// A child of a node, with its box in the scene's centred frame.
struct Entry {
  std::uint32_t child = 0;
  Box box;
};

struct EntryPairAt {
  double travel;  ///< The pair is apart before this [m].
  Entry scene, part;
  bool operator<(const EntryPairAt& other) const noexcept { return travel > other.travel; }
};

bool isUseful(std::uint32_t child) noexcept {
  if (child == NormalConeTree::kNoChild) return false;
  return !NormalConeTree::isLeaf(child) || NormalConeTree::leafKind(child) == FeatureKind::Face;
}

class Search {
 public:
  Search(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
         const glm::dvec3& direction, double within, const std::function<void()>& onWork)
      : scene_(scene),
        part_(part),
        placed_(scene, part, sceneFromPart),
        turn_(glm::mat3_cast(placed_.pose().rotation)),
        direction_(direction),
        slack_(placed_.rounding()),
        within_(within),
        onWork_(onWork) {}

  StraightContact run() {
    for (const Entry& s : childrenOf(scene_, 0, false)) {
      for (const Entry& p : childrenOf(part_, 0, true))
        add(s, p);
    }
    while (!waiting_.empty() && waiting_.top().travel < within_) {
      const EntryPairAt pair = waiting_.top();
      waiting_.pop();
      if (++result_.nodePairs % kBetweenCalls == 0 && onWork_) onWork_();
      open(pair);
    }
    result_.point += scene_.centre();
    return result_;
  }

 private:
  std::vector<Entry> childrenOf(const NormalConeTree& tree, std::uint32_t node, bool isPart) const {
    std::vector<Entry> children;
    const NormalConeTree::Node& n = tree.nodes()[node];
    for (std::size_t lane = 0; lane < NormalConeTree::kWidth; ++lane) {
      if (!isUseful(n.child[lane])) continue;
      const NormalConeTree::Bound b = n.bound(lane);
      Entry entry{n.child[lane],
                  {{b.centre[0], b.centre[1], b.centre[2]},
                   {{b.n[0], b.n[1], b.n[2]}, {b.u[0], b.u[1], b.u[2]}, {b.v[0], b.v[1], b.v[2]}},
                   {b.half[0], b.half[1], b.half[2]}}};
      if (isPart) {
        entry.box.centre = turn_ * entry.box.centre + placed_.pose().translation;
        entry.box.axes = turn_ * entry.box.axes;
      }
      children.push_back(entry);
    }
    return children;
  }

  /// Earliest travel at which the boxes may touch; std::nullopt if they do not.
  std::optional<double> meeting(const Box& a, const Box& b) const noexcept {
    const double slack = slack_ + kBoxSlack * (a.size() + b.size());
    const glm::dvec3 between = b.centre - a.centre;
    SweepStretch stretch;
    stretch.to = within_;
    for (const Box* box : {&a, &b}) {
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3& axis = box->axes[k];
        const double reach = radiusAlong(a, axis) + radiusAlong(b, axis) + slack;
        const double apart = glm::dot(between, axis);
        stretch.cut(apart - reach, apart + reach, glm::dot(direction_, axis));
        if (stretch.isEmpty()) return std::nullopt;
      }
    }
    return stretch.from;
  }

  void add(const Entry& s, const Entry& p) {
    const std::optional<double> travel = meeting(s.box, p.box);
    if (travel && *travel < within_) waiting_.push({*travel, s, p});
  }

  void open(const EntryPairAt& pair) {
    const bool isSceneLeaf = NormalConeTree::isLeaf(pair.scene.child);
    const bool isPartLeaf = NormalConeTree::isLeaf(pair.part.child);
    if (isSceneLeaf && isPartLeaf) {
      test(NormalConeTree::leafIndex(pair.scene.child), NormalConeTree::leafIndex(pair.part.child));
    } else if (isPartLeaf || (!isSceneLeaf && pair.scene.box.size() > pair.part.box.size())) {
      for (const Entry& s : childrenOf(scene_, pair.scene.child, false))
        add(s, pair.part);
    } else {
      for (const Entry& p : childrenOf(part_, pair.part.child, true))
        add(pair.scene, p);
    }
  }

  void test(std::uint32_t s, std::uint32_t p) {
    const NormalConeTree::FaceLeaf &sceneFace = scene_.faces()[s], &partFace = part_.faces()[p];
    const TriangleCorners fixed = placed_.sceneCorners(sceneFace), moving = placed_.partCorners(partFace);
    const SweepHit hit = sweepTriangles(fixed, moving, direction_, within_);
    if (!(hit.travel < within_)) return;
    within_ = hit.travel;
    result_.isFound = true;
    result_.travel = hit.travel;
    result_.normal = hit.normal == glm::dvec3(0.0) ? -direction_ : hit.normal;
    result_.point = (moving[0] + moving[1] + moving[2]) / 3.0 + hit.travel * direction_;
    result_.sceneTriangle = sceneFace.face;
    result_.partTriangle = partFace.face;
  }

  const NormalConeTree &scene_, &part_;
  PlacedFaces placed_;
  glm::dmat3 turn_;
  glm::dvec3 direction_;
  double slack_, within_;
  const std::function<void()>& onWork_;
  std::priority_queue<EntryPairAt> waiting_;
  StraightContact result_;
};

}  // namespace

StraightContact findStraightContact(const NormalConeTree& scene, const NormalConeTree& part,
                                    const RigidTransform& sceneFromPart, const glm::dvec3& direction,
                                    double within, const std::function<void()>& onWork) {
  if (scene.isEmpty() || part.isEmpty() || !(within > 0.0)) return {};
  return Search(scene, part, sceneFromPart, direction, within, onWork).run();
}

}  // namespace nearfit
