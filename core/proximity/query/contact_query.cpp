#include "core/proximity/query/contact_query.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/proximity/query/leaf_tests.h"
#include "core/proximity/query/query_workspace.h"
#include "core/proximity/query/range_limits.h"

namespace nearfit {
namespace {

bool isNearerPair(const ContactPair& a, const ContactPair& b) noexcept {
  return a.distance < b.distance;
}

/// Collects contacts as they are found, and keeps the nearest if room runs out.
class ContactCollector {
 public:
  ContactCollector(std::span<ContactPair> out, double reach) noexcept : out_(out) {
    result_.completeTo = reach;
    result_.least = std::numeric_limits<double>::infinity();
  }

  void add(const ContactPair& contact) noexcept {
    result_.least = std::min(result_.least, contact.distance);
    if (result_.count < out_.size()) {
      out_[result_.count++] = contact;
      if (result_.count == out_.size()) std::make_heap(out_.begin(), out_.end(), isNearerPair);
      return;
    }
    // Full: replaces the farthest.
    double lost = contact.distance;
    if (!out_.empty() && isNearerPair(contact, out_.front())) {
      lost = out_.front().distance;
      std::pop_heap(out_.begin(), out_.end(), isNearerPair);
      out_.back() = contact;
      std::push_heap(out_.begin(), out_.end(), isNearerPair);
    }
    result_.completeTo = std::min(result_.completeTo, lost);
  }

  ContactResult& result() noexcept { return result_; }

 private:
  std::span<ContactPair> out_;
  ContactResult result_;
};

/// Converts what a relaxed test found to a contact in the frame of the scene's mesh.
ContactPair contactOf(const Minimum& minimum, const NormalConeTree& scene) noexcept {
  const Lmd& lmd = minimum.lmd;
  return {lmd.partPoint + scene.centre(), lmd.direction, std::min(minimum.least, lmd.distance)};
}

/// The same for what a kernel found.
ContactPair contactOf(const EdgePairHits& hits, std::size_t lane, const NormalConeTree& scene) noexcept {
  return {vectorIn(hits.partPoint, lane) + scene.centre(), vectorIn(hits.direction, lane),
          hits.distance[lane]};
}

}  // namespace

double contactTurn(double reach, double radius) noexcept {
  constexpr double kMax = 0.026;
  return radius * kMax > reach ? reach / radius : kMax;
}

NearbyPairs findNearbyPairs(const BodyPairQuery& query, const ContactReach& reach, const MotionBudget& slack,
                            LmdScratch& scratch, std::span<LeafPair> out, std::uint64_t maxWork) noexcept {
  NearbyPairs result;
  result.holds = slack;
  result.isComplete = true;
  if (!isQueryValid(query.scene, query.part, query.sceneFromPart, reach.distance)) return result;
  const RigidTransform pose = centredPose(query.scene, query.part, query.sceneFromPart);
  LmdScratch::Data& workspace = scratch.data();
  const BodyPairQuery within{query.scene, query.part, query.sceneFromPart, reach.distance};
  TreeTraversal traversal(query.scene, query.part, pose, contactLimits(within, pose, reach.turn, slack),
                          workspace.openContacts, workspace.traversal);
  bool hasRoom = true;
  const bool isDone = traversal.run(
      [&](const EntryPair& pair) {
        if (!hasRoom) return;
        const bool takesWork = result.count % kListedAtOnce == 0;
        hasRoom = result.count < out.size() && !(takesWork && traversal.nodePairs() >= maxWork);
        if (!hasRoom) {
          traversal.stop();
          return;
        }
        if (takesWork) traversal.spend(1);
        out[result.count++] = {pair.scene, pair.part};
      },
      maxWork);
  result.isComplete = isDone && hasRoom;
  result.work = traversal.nodePairs();
  return result;
}

ContactResult testContacts(const BodyPairQuery& query, const ContactReach& reach,
                           std::span<const LeafPair> pairs, std::span<ContactPair> out,
                           const PackedEdgePairs& packed) noexcept {
  ContactCollector collector(out, reach.distance);
  ContactResult& result = collector.result();
  result.leafPairs = pairs.size();
  if (!isQueryValid(query.scene, query.part, query.sceneFromPart, reach.distance)) return result;
  const RigidTransform pose = centredPose(query.scene, query.part, query.sceneFromPart);
  const LeafTests tests(query.scene, query.part, pose, reach.distance, reach.turn);
  Minimum minimum;
  const auto test = [&](const LeafPair& pair) {
    if (tests.test(pair.scene, pair.part, minimum)) collector.add(contactOf(minimum, query.scene));
  };
  // Kernels test relaxed directions only.
  const std::size_t blocks = reach.turn > 0.0 ? packed.blocks.size() : 0;
  const EdgePairLimits limits = tests.edgePairLimits();
  EdgePairHits hits;
  for (std::size_t i = 0; i < blocks; ++i) {
    packed.kernels.test(packed.blocks[i], tests.sceneFromPart(), tests.partFromScene(), limits, hits);
    for (std::uint32_t lanes = hits.found; lanes != 0; lanes &= lanes - 1)
      collector.add(contactOf(hits, static_cast<std::size_t>(std::countr_zero(lanes)), query.scene));
    for (std::uint32_t lanes = hits.undecided; lanes != 0; lanes &= lanes - 1)
      test(pairs[i * EdgePairs::kLanes + static_cast<std::size_t>(std::countr_zero(lanes))]);
  }
  for (const LeafPair& pair : pairs.subspan(blocks * EdgePairs::kLanes))
    test(pair);
  return result;
}

}  // namespace nearfit
