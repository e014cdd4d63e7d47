#include "tests/bench/tick_run.h"

#include <algorithm>
#include <utility>

#include "core/servo/scene_tracker.h"
#include "device/servo/servo_loop.h"
#include "tests/bench/digest.h"

namespace nearfit::bench {
namespace {

/// One scene with the servo's state in it, and what it has measured.
class TickLane {
 public:
  TickLane(const TickScene& scene, double cutoff, const RunOptions& options)
      : options_(options), alter_(scene.alter) {
    parameters_.haptics.mode = scene.mode;
    parameters_.haptics.springs.cutoff = cutoff;
    parameters_.haptics.springs.damping = 1.0;
    run_.name = scene.name;
    run_.parts = scene.scene->bodies.size();
    tracker_.setScene(scene.scene);
    snapshot_->proxy = scene.scene->moving.worldFromPart;
  }

  void walk(std::span<const RigidTransform> poses) {
    std::size_t untimed = options_.warmUp;
    for (const RigidTransform& pose : poses) {
      const bool isTimed = untimed == 0;
      if (!isTimed) --untimed;
      keepAhead(pose, isTimed);
      const double start = secondsBy(options_.clock);
      tick_.run(tracked_, parameters_, {.pose = pose}, ServoLoop::kPeriod, *snapshot_);
      const double time = secondsBy(options_.clock) - start;
      if (isTimed) run_.tickTimes.push_back(time);
      note();
    }
  }

  TickRun result() { return std::move(run_); }

 private:
  void keepAhead(const RigidTransform& pose, bool isTimed) {
    const SearchReach reach = searchReach(parameters_.haptics);
    // Springs let the part be where the hand is.
    const bool isAtHand = parameters_.haptics.mode == HapticMode::Springs;
    tracker_.update(
        {isAtHand ? pose : snapshot_->proxy, std::nullopt, snapshot_->isWaiting, snapshot_->isStarved}, 1.0);
    if (tracked_.scene && !tracker_.isDue(reach)) return;
    const double start = secondsBy(options_.clock);
    tracker_.refresh(reach, tracked_);
    if (isTimed) run_.refreshTimes.push_back(secondsBy(options_.clock) - start);
    if (alter_) alter_(tracked_);
  }

  void note() {
    run_.digests.push_back(digestOf(*snapshot_));
    run_.lateTicks += snapshot_->lateBodies > 0 ? 1 : 0;
    run_.truncatedTicks += snapshot_->isTruncated ? 1 : 0;
    run_.ticksWithMinima += snapshot_->lmdCount > 0 ? 1 : 0;
    run_.mostNear = std::max(run_.mostNear, tracked_.near.size());
  }

  const RunOptions& options_;
  std::function<void(TrackedScene&)> alter_;
  ServoParameters parameters_;
  SceneTracker tracker_;
  TrackedScene tracked_;
  ServoTick tick_;
  std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
  TickRun run_;
};

}  // namespace

std::uint64_t digestOf(const ServoSnapshot& snapshot) noexcept {
  Digest digest;
  for (const Wrench& wrench : {snapshot.wrench, snapshot.unclampedWrench}) {
    digest.add(wrench.force);
    digest.add(wrench.torque);
  }
  digest.add(snapshot.distance);
  digest.add(std::uint64_t{snapshot.lmdCount});
  for (std::uint32_t i = 0; i < snapshot.storedLmds; ++i) {
    digest.add(snapshot.lmds[i].lmd);
    digest.add(static_cast<std::uint64_t>(snapshot.lmds[i].other));
  }
  return digest.value();
}

std::optional<std::size_t> firstDifference(const TickRun& a, const TickRun& b) {
  const auto [first, second] =
      std::mismatch(a.digests.begin(), a.digests.end(), b.digests.begin(), b.digests.end());
  if (first == a.digests.end() && second == b.digests.end()) return std::nullopt;
  return static_cast<std::size_t>(first - a.digests.begin());
}

std::vector<TickRun> runTicks(std::span<const TickScene> scenes, std::span<const RigidTransform> path,
                              double cutoff, const RunOptions& options) {
  if (options.cpu) pinTo(*options.cpu);
  std::vector<std::unique_ptr<TickLane>> lanes;
  for (const TickScene& scene : scenes)
    lanes.push_back(std::make_unique<TickLane>(scene, cutoff, options));
  for (std::size_t round = 0; round < options.rounds; ++round) {
    for (std::size_t begin = 0; begin < path.size(); begin += options.block) {
      const std::size_t count = std::min(options.block, path.size() - begin);
      for (std::size_t i = 0; i < lanes.size(); ++i)
        lanes[(i + round) % lanes.size()]->walk(path.subspan(begin, count));
    }
  }
  std::vector<TickRun> runs;
  for (const std::unique_ptr<TickLane>& lane : lanes)
    runs.push_back(lane->result());
  return runs;
}

}  // namespace nearfit::bench
