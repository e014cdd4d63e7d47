#include "tests/bench/interleaved_run.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>

#include "core/error.h"

namespace nearfit::bench {
namespace {

void pinTo(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0) {
    throw UsageError("--pin", fmt::format("processor {} cannot be had ({})", cpu, std::strerror(errno)),
                     "choose one that this process may use");
  }
}

long preemptionsOfThread() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

/// One method with its state and what it has measured.
struct Lane {
  std::unique_ptr<QueryMethod> query;
  std::size_t stride;
  MethodRun run;
};

void walkBlock(Lane& lane, std::span<const RigidTransform> path, std::size_t begin, std::size_t end,
               std::size_t warmUp, bool isFirstRound) {
  begin = (begin + lane.stride - 1) / lane.stride * lane.stride;
  if (begin >= end) return;
  // A pair-lister has no memory to warm but that of the machine: one pose will do.
  const std::size_t lead = lane.stride > 1 ? 1 : std::min(warmUp, std::max<std::size_t>(begin, 1));
  for (std::size_t i = 0; i < lead && warmUp > 0; ++i)
    lane.query->query(path[begin >= lead ? begin - lead + i : i]);
  const long before = preemptionsOfThread();
  for (std::size_t i = begin; i < end; i += lane.stride) {
    const auto start = std::chrono::steady_clock::now();
    const Answer answer = lane.query->query(path[i]);
    const auto stop = std::chrono::steady_clock::now();
    lane.run.times.push_back(std::chrono::duration<double>(stop - start).count());
    if (isFirstRound) {
      lane.run.poses.push_back(i);
      lane.run.answers.push_back(answer);
    }
  }
  lane.run.preemptions += preemptionsOfThread() - before;
}

}  // namespace

std::vector<MethodRun> runInterleaved(std::span<const MethodEntry> methods, const PreparedScene& scene,
                                      std::span<const RigidTransform> path, const RunOptions& options) {
  std::vector<Lane> lanes;
  for (const MethodEntry& method : methods) {
    const std::size_t stride = method.kind == AnswerKind::Pairs ? options.pairsStride : 1;
    lanes.push_back({method.make(scene), stride, MethodRun{&method, {}, {}, {}}});
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
        walkBlock(lanes[(i + round) % lanes.size()], path, begin, end, options.warmUp, round == 0);
    }
  }
  std::vector<MethodRun> runs;
  for (Lane& lane : lanes)
    runs.push_back(std::move(lane.run));
  return runs;
}

}  // namespace nearfit::bench
