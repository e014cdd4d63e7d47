#include "core/servo/prepared_pairs.h"

#include <algorithm>
#include <limits>

#include "core/servo/tracked_scene.h"

namespace nearfit {
namespace {

/// Size of the cells that contacts are grouped by, as a share of the part's least gyration.
constexpr double kCellOfGyration = 0.2;
/// Contacts beyond this share of the reach asked for are left out: a step seldom meets them.
constexpr double kNeeded = 1.45 / kContactReach;
/// A look finds all contacts within this share of the reach, those that may be nearer than the margin. Of what is farther
/// it finds what was nearest before, which is nearly all; the rest it finds once it comes near.
constexpr double kSure = 0.98 / kContactReach;
/// And up to this one contacts hold the part: where one is lost, others are looked for.
constexpr double kHeld = 1.02 / kContactReach;
/// Contacts taken from a look at once.
constexpr std::size_t kTaken = 1024;

}  // namespace

double reachOfThousands(double contactReach) noexcept {
  return kReachOfThousands / kContactReach * contactReach;
}

ManyPairs::Asked askedAmongThousands(const ServoScene& scene, const ServoScene::Body& other,
                                     const RigidTransform& sceneFromPart, double reach,
                                     double contactReach) noexcept {
  const glm::dvec3& gyration = scene.metric.gyration;
  return {.scene = &other.geometry->tree(),
          .part = &scene.moving.geometry->tree(),
          .sceneFromPart = sceneFromPart,
          .reach = {reach, contactTurn(reach, scene.metric.radius)},
          .need = std::min(kNeeded * contactReach, reach),
          .sure = std::min(kSure * contactReach, reach),
          .held = std::min(kHeld * contactReach, reach),
          .cell = kCellOfGyration * std::min({gyration.x, gyration.y, gyration.z})};
}

void PairPreparer::prepare(const ServoScene& scene, const ServoScene::Body& body, const CandidateList& list,
                           const RigidTransform& sceneFromPart, double contactReach, std::uint64_t serial,
                           PreparedPairs& out) {
  contacts_.resize(kTaken);
  listed_.clear();
  list.appendPairs(listed_);
  std::uint64_t work = std::numeric_limits<std::uint64_t>::max();
  pairs_.beginHolding(listed_, motionBetween(pose_, sceneFromPart, 0.0).turn);
  pairs_.goOnHolding(work);
  pose_ = sceneFromPart;
  const double reach = std::min(list.cutoff(), reachOfThousands(contactReach));
  pairs_.begin(askedAmongThousands(scene, body, sceneFromPart, reach, contactReach));
  for (bool isDone = false; !isDone;) {
    std::size_t count = 0;
    isDone = pairs_.goOn(work, contacts_, count).has_value();
  }
  out.pairs_.takeForLooks(pairs_);
  out.serial_ = serial;
  out.reach_ = reach;
  out.owner_ = nullptr;
}

}  // namespace nearfit
