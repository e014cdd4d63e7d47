#include "core/placing/straight_contact.h"

#include <cmath>
#include <optional>
#include <queue>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/placing/sweep_stretch.h"
#include "core/placing/triangle_sweep.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/surface/near_faces.h"

namespace nearfit {
namespace {

/// Max error of a node's single-precision box, as a fraction of its size: its axes are unit and
/// perpendicular to 1e-7.
constexpr double kBoxSlack = 1e-6;
/// Pairs of nodes between two calls of onWork.
constexpr std::uint64_t kBetweenCalls = 2048;

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
