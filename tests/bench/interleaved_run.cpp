#include "tests/bench/interleaved_run.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>

#include "core/base/error.h"

namespace nearfit::bench {
namespace {

long preemptionsOfThread() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

/// One method with its state and what it has measured.
struct QueryLane {
  std::unique_ptr<QueryMethod> query;
  std::size_t stride;
  MethodRun run;
};

/// Waits for each of evenly spaced times; those that are missed are not made up for.
class Ticks {
 public:
  explicit Ticks(double period)
      : period_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period))) {}

  void wait() {
    if (period_ == Clock::duration::zero()) return;
    next_ = std::max(next_ + period_, Clock::now());
    std::this_thread::sleep_until(next_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::duration period_;
  Clock::time_point next_ = Clock::now();
};

/// Poses [begin, end) of a path, in one go.
struct Block {
  std::span<const RigidTransform> path;
  std::size_t begin, end;
  bool isFirstRound;
};

void walkBlock(QueryLane& lane, const Block& block, const RunOptions& options) {
  const std::size_t begin = (block.begin + lane.stride - 1) / lane.stride * lane.stride;
  if (begin >= block.end) return;
  // A slow method remembers nothing: one pose will do to warm the caches.
  const std::size_t warmUp = lane.stride > 1 ? std::min<std::size_t>(options.warmUp, 1) : options.warmUp;
  for (std::size_t i = begin - std::min(begin, warmUp); i < begin; ++i) {
    lane.query->query(block.path[i]);
    lane.query->workAside(block.path[i]);
  }
  const long before = preemptionsOfThread();
  Ticks ticks(options.period);
  for (std::size_t i = begin; i < block.end; i += lane.stride) {
    ticks.wait();
    const double start = secondsBy(options.clock);
    const Answer answer = lane.query->query(block.path[i]);
    lane.run.times.push_back(secondsBy(options.clock) - start);
    lane.query->workAside(block.path[i]);
    if (!block.isFirstRound) continue;
    lane.run.poses.push_back(i);
    lane.run.answers.push_back(answer);
  }
  lane.run.preemptions += preemptionsOfThread() - before;
}

}  // namespace

void pinTo(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0) {
    throw UsageError("--pin", fmt::format("processor {} cannot be had ({})", cpu, std::strerror(errno)),
                     "choose one that this process may use");
  }
}

std::vector<MethodRun> runInterleaved(std::span<const MethodEntry> methods, const PreparedScene& scene,
                                      std::span<const RigidTransform> path, const RunOptions& options) {
  std::vector<QueryLane> lanes;
  for (const MethodEntry& method : methods) {
    const std::size_t stride = isSlow(method.kind) ? options.pairsStride : 1;
    lanes.push_back({method.make(scene), stride, MethodRun{&method, {}, {}, {}, {}}});
    lanes.back().run.times.reserve(path.size() * options.rounds);
    lanes.back().run.answers.reserve(path.size());
    lanes.back().run.poses.reserve(path.size());
  }
  // After the methods are made: threads of theirs keep all processors.
  if (options.cpu) pinTo(*options.cpu);
  for (std::size_t round = 0; round < options.rounds; ++round) {
    for (std::size_t begin = 0; begin < path.size(); begin += options.block) {
      const std::size_t end = std::min(begin + options.block, path.size());
      for (std::size_t i = 0; i < lanes.size(); ++i)
        walkBlock(lanes[(i + round) % lanes.size()], {path, begin, end, round == 0}, options);
    }
  }
  std::vector<MethodRun> runs;
  for (QueryLane& lane : lanes) {
    lane.run.remark = lane.query->remark();
    runs.push_back(std::move(lane.run));
  }
  return runs;
}

}  // namespace nearfit::bench
