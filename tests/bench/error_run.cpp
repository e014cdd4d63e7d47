#include "tests/bench/error_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "core/parallel/parallel_for.h"
#include "tests/bench/error_shapes.h"
#include "tests/bench/portable_random.h"
#include "tests/bench/statistics.h"
#include "tests/bench/units.h"

namespace nearfit::bench {
namespace {

constexpr double kStep = 2e-4;                             // A tick [m].
constexpr double kTurn = 0.05 * std::numbers::pi / 180.0;  // A tick [rad].

/// What was measured of one method at one fineness.
struct Lane {
  const ErrorMethodEntry* entry;
  std::unique_ptr<ErrorMethod> method;
  std::vector<double> times{};   ///< Of the answers at the poses.
  std::vector<double> asides{};  ///< Of what is done beside each tick of each way.
  std::vector<AnswerErrors> errors{};
  std::vector<std::vector<Lmd>> minima{};  ///< Of each pose.
};

/// Made side by side: that takes longer than what is measured, and is not timed.
std::vector<Lane> lanesOf(std::span<const ErrorMethodEntry> methods, const ErrorScene& scene) {
  const BenchScene& meshes = scene.bodies.meshes;
  const std::size_t triangles = meshes.scene.triangles().size() + meshes.part.triangles().size();
  std::vector<Lane> lanes;
  for (const ErrorMethodEntry& entry : methods) {
    if (triangles <= entry.maxTriangles) lanes.push_back({&entry, nullptr});
  }
  parallelFor(lanes.size(), [&](std::size_t i) { lanes[i].method = lanes[i].entry->make(scene); });
  return lanes;
}

void answerPose(Lane& lane, const ErrorScene& scene, const ErrorPose& pose, std::uint64_t seed, double edge,
                BenchClock clock) {
  ContactAnswer answer;
  const std::vector<RigidTransform> way = wayTo(pose.sceneFromPart, lane.entry->leadIn + 1, seed);
  double time = 0.0;
  for (const RigidTransform& step : way) {
    answer.clear();
    const double start = secondsBy(clock);
    lane.method->answer(step, answer);
    const double answered = secondsBy(clock);
    time = answered - start;
    lane.method->workAside(step);
    lane.asides.push_back(secondsBy(clock) - answered);
  }
  lane.times.push_back(time);
  lane.errors.push_back(errorsOf(answer, pose, scene.springs, edge));
  lane.minima.push_back(std::move(answer.minima));
}

/// @param member  Which error; of poses without a match, those that need one count for nothing.
ErrorSummary summaryOf(const std::vector<AnswerErrors>& errors, double AnswerErrors::* member,
                       bool needsMatch) {
  double sum = 0.0, max = 0.0, count = 0.0;
  for (const AnswerErrors& e : errors) {
    if (needsMatch && e.matched == 0) continue;
    sum += e.*member * (e.*member);
    max = std::max(max, e.*member);
    count += 1.0;
  }
  if (count == 0.0)
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  return {std::sqrt(sum / count), max};
}

double meanOf(const std::vector<AnswerErrors>& errors, std::size_t AnswerErrors::* member) {
  double sum = 0.0;
  for (const AnswerErrors& e : errors)
    sum += static_cast<double>(e.*member);
  return sum / static_cast<double>(errors.size());
}

ErrorRow rowOf(const Lane& lane) {
  ErrorRow row;
  row.method = lane.entry->name;
  row.poses = lane.times.size();
  row.bytes = lane.method->byteSize();
  const SampleSummary times(lane.times);
  row.p50 = kMicro * times.percentile(0.5);
  row.p99 = kMicro * times.percentile(0.99);
  row.aside = kMicro * SampleSummary(lane.asides).mean();
  row.missed = meanOf(lane.errors, &AnswerErrors::missed);
  row.spurious = meanOf(lane.errors, &AnswerErrors::spurious);
  row.extra = meanOf(lane.errors, &AnswerErrors::extra);
  const double matched = meanOf(lane.errors, &AnswerErrors::matched);
  row.truths = matched + row.missed;
  row.minima = matched + row.spurious + row.extra;
  row.distance = summaryOf(lane.errors, &AnswerErrors::distance, true);
  row.position = summaryOf(lane.errors, &AnswerErrors::position, true);
  row.direction = summaryOf(lane.errors, &AnswerErrors::direction, true);
  row.force = summaryOf(lane.errors, &AnswerErrors::force, false);
  row.torque = summaryOf(lane.errors, &AnswerErrors::torque, false);
  return row;
}

std::size_t differingPoses(const Lane& lane, const std::vector<Lane>& lanes) {
  if (!lane.entry->isExact) return 0;
  const auto first =
      std::find_if(lanes.begin(), lanes.end(), [](const Lane& other) { return other.entry->isExact; });
  std::size_t count = 0;
  for (std::size_t i = 0; i < lane.minima.size(); ++i)
    count += areSame(lane.minima[i], first->minima[i]) ? 0 : 1;
  return count;
}

double edgeOf(const ErrorPair& pair, const ErrorScene& scene) {
  const double part = longestEdge(scene.bodies.meshes.part);
  return pair.isSceneCurved ? std::max(part, longestEdge(scene.bodies.meshes.scene)) : part;
}

}  // namespace

std::vector<RigidTransform> wayTo(const RigidTransform& pose, std::size_t ticks, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const glm::dvec3 step = kStep * randomDirection(random), axis = randomDirection(random);
  std::vector<RigidTransform> way;
  for (std::size_t i = 1; i < ticks; ++i) {
    const auto before = static_cast<double>(ticks - i);
    way.push_back({glm::angleAxis(-kTurn * before, axis) * pose.rotation, pose.translation - before * step});
  }
  way.push_back(pose);
  return way;
}

bool areSame(std::span<const Lmd> a, std::span<const Lmd> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Lmd& l, const Lmd& r) {
    return l.scenePoint == r.scenePoint && l.partPoint == r.partPoint && l.distance == r.distance &&
           l.direction == r.direction && l.sceneFeature == r.sceneFeature && l.sceneIndex == r.sceneIndex &&
           l.partFeature == r.partFeature && l.partIndex == r.partIndex && l.isRegion == r.isRegion;
  });
}

std::vector<ErrorRow> runErrors(const ErrorPair& pair, std::span<const ErrorMethodEntry> methods,
                                const ErrorRunOptions& options,
                                const std::function<void(const ErrorRow&)>& onRow) {
  const std::vector<ErrorPose> poses = randomPoses(pair, options.poses, options.seed);
  std::vector<ErrorRow> rows;
  for (const std::uint32_t fineness : options.finenesses) {
    const ErrorScene scene(pair.scene(fineness), pair.part(fineness), pair.cutoff);
    const double edge = edgeOf(pair, scene);
    std::vector<Lane> lanes = lanesOf(methods, scene);
    for (std::size_t begin = 0; begin < poses.size(); begin += options.block) {
      for (Lane& lane : lanes) {
        for (std::size_t i = begin; i < std::min(poses.size(), begin + options.block); ++i)
          answerPose(lane, scene, poses[i], options.seed + i, edge, options.clock);
      }
    }
    for (const Lane& lane : lanes) {
      ErrorRow row = rowOf(lane);
      row.pair = pair.name;
      row.fineness = fineness;
      row.edge = edge;
      row.sceneTriangles = scene.bodies.meshes.scene.triangles().size();
      row.partTriangles = scene.bodies.meshes.part.triangles().size();
      row.differing = differingPoses(lane, lanes);
      rows.push_back(row);
      if (onRow) onRow(row);
    }
  }
  return rows;
}

}  // namespace nearfit::bench
