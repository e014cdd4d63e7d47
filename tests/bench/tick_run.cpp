#include "tests/bench/tick_run.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/haptics/scene_tracker.h"
#include "device/servo_loop.h"

namespace nearfit::bench {
namespace {

/// FNV-1a, by words in place of bytes.
class Digest {
 public:
  void add(std::uint64_t word) noexcept {
    value_ = (value_ ^ word) * 0x100000001b3U;
    value_ ^= value_ >> 32;  // Else the highest bits of a word would reach nothing but themselves.
  }
  void add(double number) noexcept { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const glm::dvec3& v) noexcept {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  void add(const RegionExtent& extent) noexcept {
    add(extent.axis);
    for (const double length :
         {extent.measure, extent.halfLength, extent.halfWidth, extent.inside.x, extent.inside.y})
      add(length);
    add(std::uint64_t{extent.dimension});
  }
  void add(const Lmd& lmd) noexcept {
    add(lmd.scenePoint);
    add(lmd.partPoint);
    add(lmd.direction);
    add(lmd.distance);
    add(std::uint64_t{lmd.sceneIndex} << 32 | lmd.partIndex);
    add(static_cast<std::uint64_t>(lmd.sceneFeature) << 8 | static_cast<std::uint64_t>(lmd.partFeature) << 4 |
        (lmd.isRegion ? 2U : 0U) | (lmd.isBlocked ? 1U : 0U));
    if (lmd.isRegion) add(lmd.extent);
  }
  std::uint64_t value() const noexcept { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

/// One scene with the servo's state in it, and what it has measured.
class Lane {
 public:
  Lane(const TickScene& scene, double cutoff, const RunOptions& options) : options_(options) {
    parameters_.haptics.mode = HapticMode::Springs;
    parameters_.haptics.springs.cutoff = cutoff;
    parameters_.haptics.springs.damping = 1.0;
    run_.name = scene.name;
    run_.parts = scene.scene->bodies.size();
    tracker_.setScene(scene.scene);
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
    const double cutoff = parameters_.haptics.springs.cutoff;
    tracker_.observe(pose, 1.0);
    if (tracked_.scene && !tracker_.isDue({cutoff})) return;
    const double start = secondsBy(options_.clock);
    tracker_.refresh({cutoff}, tracked_);
    if (isTimed) run_.refreshTimes.push_back(secondsBy(options_.clock) - start);
  }

  void note() {
    run_.digests.push_back(digestOf(*snapshot_));
    run_.lateTicks += snapshot_->lateBodies > 0 ? 1 : 0;
    run_.truncatedTicks += snapshot_->isTruncated ? 1 : 0;
    run_.ticksWithMinima += snapshot_->lmdCount > 0 ? 1 : 0;
    run_.mostNear = std::max(run_.mostNear, tracked_.near.size());
  }

  const RunOptions& options_;
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
  std::vector<std::unique_ptr<Lane>> lanes;
  for (const TickScene& scene : scenes)
    lanes.push_back(std::make_unique<Lane>(scene, cutoff, options));
  for (std::size_t round = 0; round < options.rounds; ++round) {
    for (std::size_t begin = 0; begin < path.size(); begin += options.block) {
      const std::size_t count = std::min(options.block, path.size() - begin);
      for (std::size_t i = 0; i < lanes.size(); ++i)
        lanes[(i + round) % lanes.size()]->walk(path.subspan(begin, count));
    }
  }
  std::vector<TickRun> runs;
  for (const std::unique_ptr<Lane>& lane : lanes)
    runs.push_back(lane->result());
  return runs;
}

}  // namespace nearfit::bench
