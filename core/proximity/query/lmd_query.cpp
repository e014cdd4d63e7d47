#include "core/proximity/query/lmd_query.h"

#include <algorithm>
#include <limits>

#include "core/proximity/query/leaf_tests.h"
#include "core/proximity/query/query_workspace.h"

namespace nearfit {

LmdScratch::LmdScratch(std::size_t capacity, SimdLevel simd)
    : data_(std::make_unique<Data>(std::max<std::size_t>(capacity, 1), simd)) {}
LmdScratch::~LmdScratch() = default;
LmdScratch::LmdScratch(LmdScratch&&) noexcept = default;
LmdScratch& LmdScratch::operator=(LmdScratch&&) noexcept = default;

void LmdScratch::holdAtMost(std::size_t pieces) noexcept {
  data_->room = std::clamp<std::size_t>(pieces, 1, data_->minima.size());
}

namespace {

/// One search, whose cutoff can be tightened as it runs.
class Search {
 public:
  Search(const BodyPairQuery& query, LmdScratch::Data& workspace) noexcept
      : query_(query),
        pose_(centredPose(query.scene, query.part, query.sceneFromPart)),
        tests_(query.scene, query.part, pose_, query.cutoff),
        collector_(workspace, result_),
        traversal_(query.scene, query.part, pose_, cullLimits(query.scene, query.part, pose_, query.cutoff),
                   workspace.open, workspace.traversal) {}

  /// Finds all minima within the cutoff; false if that exceeds the work.
  bool all(std::uint64_t maxNodePairs) noexcept {
    return traversal_.run([this](const EntryPair& pair) { test(pair); }, maxNodePairs);
  }

  /// Continues, but only for minima nearer than the nearest so far.
  bool nearest(std::uint64_t maxNodePairs) noexcept {
    const auto tighten = [this] { traversal_.tighten(static_cast<float>(kNearestSlack * nearest_)); };
    if (nearest_ < query_.cutoff) tighten();
    return traversal_.goOn(
        [&](const EntryPair& pair) {
          if (test(pair)) tighten();
        },
        maxNodePairs);
  }

  /// @param completeTo  Every minimum nearer than this was found [m].
  LmdResult finish(std::span<Lmd> out, double completeTo) noexcept {
    result_.nodePairs = traversal_.nodePairs() - result_.leafPairs;
    result_.completeTo = completeTo;
    if (completeTo < query_.cutoff) result_.status = QueryStatus::Truncated;
    collector_.finish(query_.scene, query_.part, out);
    return result_;
  }

  double nearestSoFar() const noexcept { return nearest_; }

 private:
  /// True if the pair carries the nearest minimum so far.
  bool test(const EntryPair& pair) noexcept {
    ++result_.leafPairs;
    traversal_.spend(1);
    Minimum& slot = collector_.slot();
    if (!tests_.test(pair.scene, pair.part, slot)) return false;
    const bool isNearest = slot.lmd.distance < nearest_;
    if (isNearest) nearest_ = slot.lmd.distance;
    collector_.add();
    return isNearest;
  }

  const BodyPairQuery query_;
  const RigidTransform pose_;
  const LeafTests tests_;
  LmdResult result_;
  MinimaCollector collector_;
  TreeTraversal traversal_;
  double nearest_ = std::numeric_limits<double>::infinity();
};

}  // namespace

LmdResult findLmds(const NormalConeTree& scene, const NormalConeTree& part,
                   const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                   std::span<Lmd> out, std::uint64_t maxNodePairs) noexcept {
  if (!isQueryValid(scene, part, sceneFromPart, cutoff)) return LmdResult{.completeTo = cutoff};
  Search search({scene, part, sceneFromPart, cutoff}, scratch.data());
  return search.finish(out, search.all(maxNodePairs) ? cutoff : 0.0);
}

LmdResult findNearestLmds(const NormalConeTree& scene, const NormalConeTree& part,
                          const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                          std::span<Lmd> out, std::uint64_t maxNodePairs) noexcept {
  if (!isQueryValid(scene, part, sceneFromPart, cutoff)) return LmdResult{.completeTo = cutoff};
  Search search({scene, part, sceneFromPart, cutoff}, scratch.data());
  if (search.all(maxNodePairs / 2)) return search.finish(out, cutoff);
  return search.finish(out, search.nearest(maxNodePairs) ? std::min(search.nearestSoFar(), cutoff) : 0.0);
}

}  // namespace nearfit
