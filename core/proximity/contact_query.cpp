#include "core/proximity/contact_query.h"

#include <algorithm>
#include <limits>

#include "core/proximity/leaf_tests.h"
#include "core/proximity/query_workspace.h"
#include "core/proximity/range_limits.h"

namespace nearfit {
namespace {

bool isNearer(const ContactPair& a, const ContactPair& b) noexcept {
  return a.distance < b.distance;
}

/// Takes contacts in as they are found and keeps the nearest when there is no more room.
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
      if (result_.count == out_.size()) std::make_heap(out_.begin(), out_.end(), isNearer);
      return;
    }
    // Full: the farthest makes room.
    double lost = contact.distance;
    if (!out_.empty() && isNearer(contact, out_.front())) {
      lost = out_.front().distance;
      std::pop_heap(out_.begin(), out_.end(), isNearer);
      out_.back() = contact;
      std::push_heap(out_.begin(), out_.end(), isNearer);
    }
    result_.completeTo = std::min(result_.completeTo, lost);
  }

  ContactResult& result() noexcept { return result_; }

 private:
  std::span<ContactPair> out_;
  ContactResult result_;
};

/// A contact in the frame of the scene's mesh from what a relaxed test found.
ContactPair contactOf(const Minimum& minimum, const NormalConeTree& scene) noexcept {
  const Lmd& lmd = minimum.lmd;
  return {lmd.partPoint + scene.centre(), lmd.direction, std::min(minimum.least, lmd.distance)};
}

}  // namespace

double contactTurn(double reach, double radius) noexcept {
  constexpr double kMost = 0.026;
  return radius * kMost > reach ? reach / radius : kMost;
}

bool spansContact(std::uint32_t sceneLeaf, std::uint32_t partLeaf) noexcept {
  using enum FeatureKind;
  const FeatureKind a = NormalConeTree::leafKind(sceneLeaf), b = NormalConeTree::leafKind(partLeaf);
  return (a != Face || b == Vertex) && (b != Face || a == Vertex);
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
                          workspace.open, workspace.traversal);
  bool hasRoom = true;
  const bool isDone = traversal.run(
      [&](const EntryPair& pair) {
        if (!hasRoom || !spansContact(pair.scene, pair.part)) return;
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
                           std::span<const LeafPair> pairs, std::span<ContactPair> out) noexcept {
  ContactCollector collector(out, reach.distance);
  ContactResult& result = collector.result();
  result.leafPairs = pairs.size();
  if (!isQueryValid(query.scene, query.part, query.sceneFromPart, reach.distance)) return result;
  const RigidTransform pose = centredPose(query.scene, query.part, query.sceneFromPart);
  const LeafTests tests(query.scene, query.part, pose, reach.distance, reach.turn);
  Minimum minimum;
  for (const LeafPair& pair : pairs) {
    if (tests.test(pair.scene, pair.part, minimum)) collector.add(contactOf(minimum, query.scene));
  }
  return result;
}

}  // namespace nearfit
