#include "tests/bench/tracked_query.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tests/bench/arrival_delay.h"
#include "tests/bench/bench_clock.h"
#include "tests/bench/statistics.h"

namespace nearfit::bench {

TrackedQuery::TrackedQuery(const PreparedScene& scene)
    : scene_(scene),
      tracker_(scene.sceneTree, scene.partTree),
      scratch_(kQueryCapacity),
      lmds_(kQueryCapacity) {}

Answer TrackedQuery::query(const RigidTransform& sceneFromPart) {
  ++tick_;
  if (isUnderWay_ && tick_ >= readyAt_) {
    front_ = 1 - front_;
    isUnderWay_ = false;
  }
  std::optional<LmdResult> result = lists_[front_].query(sceneFromPart, scene_.cutoff, scratch_, lmds_);
  if (!result) {
    ++late_;
    result = findLmds(scene_.sceneTree, scene_.partTree, sceneFromPart, scene_.cutoff, scratch_, lmds_);
  }
  return {result->count > 0 ? lmds_.front().distance : std::numeric_limits<double>::infinity(), result->count,
          result->status == QueryStatus::Complete};
}

void TrackedQuery::workAside(const RigidTransform& sceneFromPart) {
  tracker_.observe(sceneFromPart, 1.0);
  if (isUnderWay_ || !tracker_.isDue(lists_[front_], scene_.cutoff)) return;
  CandidateList& next = lists_[1 - front_];
  const double start = secondsBy(BenchClock::Thread);
  tracker_.refresh(next, scene_.cutoff, refreshScratch_);
  const double time = secondsBy(BenchClock::Thread) - start;
  const double delay = arrivalDelay(time);
  readyAt_ = tick_ + 1 + static_cast<std::uint64_t>(delay);
  tracker_.setLead(delay);
  isUnderWay_ = true;
  refreshTimes_.push_back(time);
  sizes_.push_back(static_cast<double>(next.size()));
}

std::string TrackedQuery::remark() const {
  if (refreshTimes_.empty()) return {};
  const SampleSummary times(refreshTimes_), sizes(sizes_);
  return fmt::format(
      "{} searches ahead in the other thread, p50 {:.1f}, p99 {:.1f}, max {:.1f} us, of up to {:.0f} "
      "pairs; {} of {} ticks late",
      refreshTimes_.size(), 1e6 * times.percentile(0.5), 1e6 * times.percentile(0.99), 1e6 * times.max(),
      sizes.max(), late_, tick_);
}

}  // namespace nearfit::bench
