#include "core/proximity/contact_query.h"

#include <algorithm>

#include "core/proximity/candidate_list.h"
#include "core/proximity/leaf_tests.h"
#include "core/proximity/query_workspace.h"

namespace nearfit {
namespace {

bool isNearer(const ContactPair& a, const ContactPair& b) noexcept {
  return a.distance < b.distance;
}

}  // namespace

double contactTurn(double reach, double radius) noexcept {
  constexpr double kMost = 0.026;
  return radius * kMost > reach ? reach / radius : kMost;
}

void ContactCollector::add(const ContactPair& contact) noexcept {
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

ContactResult findContacts(const BodyPairQuery& query, const ContactReach& reach, LmdScratch& scratch,
                           std::span<ContactPair> out, std::uint64_t maxNodePairs) noexcept {
  ContactCollector collector(out, reach.distance);
  ContactResult& result = collector.result();
  if (!isQueryValid(query.scene, query.part, query.sceneFromPart, reach.distance)) return result;
  const RigidTransform pose = centredPose(query.scene, query.part, query.sceneFromPart);
  LmdScratch::Data& workspace = scratch.data();
  const BodyPairQuery within{query.scene, query.part, query.sceneFromPart, reach.distance};
  TreeTraversal traversal(query.scene, query.part, pose, contactLimits(within, pose, reach.turn, {}),
                          workspace.open, workspace.traversal);
  const LeafTests tests(query.scene, query.part, pose, reach.distance, reach.turn);
  Minimum minimum;
  const bool isComplete = traversal.run(
      [&](const EntryPair& pair) {
        ++result.leafPairs;
        if (spansContact(pair.scene, pair.part) && tests.test(pair.scene, pair.part, minimum))
          collector.add(contactOf(minimum, query.scene));
      },
      maxNodePairs);
  if (!isComplete) result.completeTo = 0.0;
  result.nodePairs = traversal.nodePairs();
  return result;
}

bool spansContact(std::uint32_t sceneLeaf, std::uint32_t partLeaf) noexcept {
  using enum FeatureKind;
  const FeatureKind a = NormalConeTree::leafKind(sceneLeaf), b = NormalConeTree::leafKind(partLeaf);
  return (a != Face || b == Vertex) && (b != Face || a == Vertex);
}

NearbyPairs findNearbyPairs(const BodyPairQuery& query, const ContactReach& reach, const MotionBudget& slack,
                            LmdScratch& scratch, std::span<LeafPair> out,
                            std::uint64_t maxNodePairs) noexcept {
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
        if (!spansContact(pair.scene, pair.part)) return;
        if (result.count < out.size())
          out[result.count++] = {pair.scene, pair.part};
        else
          hasRoom = false;
      },
      maxNodePairs);
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
