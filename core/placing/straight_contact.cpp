#include "core/placing/straight_contact.h"

#include <optional>
#include <queue>

#include <glm/geometric.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/surface/straight_sweep.h"

namespace nearfit {
namespace {

/// Pairs of nodes between two calls of onWork.
constexpr std::uint64_t kBetweenCalls = 2048;

struct EntryPairAt {
  double travel;                   ///< The pair is apart before this [m].
  const SweptEntry *scene, *part;  ///< Kept by the sweep.
  bool operator<(const EntryPairAt& other) const noexcept { return travel > other.travel; }
};

class Search {
 public:
  Search(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
         const glm::dvec3& direction, double within, const std::function<void()>& onWork)
      : scene_(scene),
        part_(part),
        sweep_(scene, part, sceneFromPart),
        direction_(direction),
        within_(within),
        onWork_(onWork) {}

  StraightContact run() {
    for (const SweptEntry& s : sweep_.sceneChildren(0)) {
      for (const SweptEntry& p : sweep_.partChildren(0))
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
  void add(const SweptEntry& s, const SweptEntry& p) {
    const std::optional<SweepStretch> meeting = sweep_.meeting(s.box, p.box, direction_, within_);
    if (meeting && meeting->from < within_) waiting_.push({meeting->from, &s, &p});
  }

  void open(const EntryPairAt& pair) {
    if (NormalConeTree::isLeaf(pair.scene->child) && NormalConeTree::isLeaf(pair.part->child)) {
      test(NormalConeTree::leafIndex(pair.scene->child), NormalConeTree::leafIndex(pair.part->child));
    } else {
      openLarger(sweep_, *pair.scene, *pair.part,
                 [this](const SweptEntry& s, const SweptEntry& p) { add(s, p); });
    }
  }

  void test(std::uint32_t s, std::uint32_t p) {
    const NormalConeTree::FaceLeaf &sceneFace = scene_.faces()[s], &partFace = part_.faces()[p];
    const TriangleCorners fixed = sweep_.placed().sceneCorners(sceneFace),
                          moving = sweep_.placed().partCorners(partFace);
    const TriangleSweep hit = sweepTriangles(fixed, moving, direction_, within_);
    const double travel = hit.stretch.from;
    if (hit.stretch.isEmpty() || !(travel < within_)) return;
    within_ = travel;
    result_.isFound = true;
    result_.travel = travel;
    result_.normal = hit.firstNormal == glm::dvec3(0.0) ? -direction_ : hit.firstNormal;
    result_.point = (moving[0] + moving[1] + moving[2]) / 3.0 + travel * direction_;
    result_.sceneTriangle = sceneFace.face;
    result_.partTriangle = partFace.face;
  }

  const NormalConeTree &scene_, &part_;
  StraightSweep sweep_;
  glm::dvec3 direction_;
  double within_;
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
