#include "tests/bench/paper_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "core/proximity/query/lmd_query.h"
#include "device/servo/servo_loop.h"
#include "tests/bench/agreement.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/error_method.h"
#include "tests/bench/feel_scenes.h"
#include "tests/bench/feel_servo.h"
#include "tests/bench/interleaved_run.h"
#include "tests/bench/paper_hierarchy.h"
#include "tests/bench/scene_path.h"
#include "tests/bench/units.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench {
namespace {

/// How far a path may leave a row's pose, of the larger body's diagonal: a few steps, so that what is near stays so.
constexpr double kRowRange = 0.02;

/// Methods of the appendix and the sweeps, those that this program has.
std::vector<MethodEntry> sweptMethods(bool withPaper) {
  std::vector<MethodEntry> methods;
  for (MethodEntry& method : allMethods()) {
    const bool isPapers = method.name == "paper-spans" || method.name == "paper-cones";
    if (method.name == "nearfit-cold" || method.name == "nearfit-tracked" || method.name == "fcl" ||
        (isPapers && withPaper)) {
      methods.push_back(std::move(method));
    }
  }
  return methods;
}

std::vector<double> inverse(const std::vector<double>& times) {
  std::vector<double> rates;
  for (const double time : times)
    rates.push_back(1.0 / time);
  return rates;
}

std::vector<double> countsOf(const MethodRun& run) {
  std::vector<double> counts;
  for (const Answer& answer : run.answers)
    counts.push_back(static_cast<double>(answer.count));
  return counts;
}

/// Queries of all methods along a path. A benchmark of different answers is void: throws Error where an exact method
/// has another least distance or number of minima.
std::vector<PaperFigure> queryFigures(const FigureHead& head, const PreparedScene& scene,
                                      std::span<const MethodEntry> methods,
                                      std::span<const RigidTransform> path, const PaperRunOptions& options) {
  RunOptions run;
  run.clock = options.clock;
  run.block = options.block;
  run.pairsStride = options.slowStride;
  const std::vector<MethodRun> runs = runInterleaved(methods, scene, path, run);
  const std::vector<Agreement> agreements = compareRuns(runs, scene.cutoff, scene.size);
  std::vector<PaperFigure> figures;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const MethodRun& one = runs[i];
    if (!agreements[i].holds) {
      throw Error(fmt::format("{} {}", head.scene, head.setting),
                  fmt::format("{} differs from the other methods at pose {}, so the figures are void",
                              one.method->name, agreements[i].worstPose),
                  "look at the pose with nearfit-bench query");
    }
    figures.push_back(paperFigure(head, one.method->name, "query [us]", one.times, kMicro));
    if (one.method->kind != AnswerKind::Distance)
      figures.push_back(paperFigure(head, one.method->name, "minima", countsOf(one)));
  }
  return figures;
}

/// The first times hold what a process does once, as getting memory.
constexpr int kPreparations = 5;

/// Seconds that `make` takes.
template <typename Make>
double timeOf(BenchClock clock, Make&& make) {
  const double start = secondsBy(clock);
  make();
  return secondsBy(clock) - start;
}

/// Processor time of all threads to build the hierarchies of both meshes, some times [s].
std::vector<double> hierarchyTimes(const BenchScene& meshes) {
  std::vector<double> times;
  for (int i = 0; i < kPreparations; ++i) {
    times.push_back(timeOf(BenchClock::Process, [&] {
      const NormalConeTree scene = searchedTree(meshes.scene), part = searchedTree(meshes.part);
    }));
  }
  return times;
}

/// Query and forces, as a loop has them. @param stride  Asked at each so-many-th pose.
struct LoopLane {
  ErrorMethodEntry entry;
  std::size_t stride;
  std::unique_ptr<ErrorMethod> method;
  std::vector<double> prepared;  ///< Times to make it with all that it holds, of all threads [s].
  std::vector<double> times{};   ///< Of the loop.
  std::vector<double> wholes{};  ///< With what another thread would do beside it.
};

std::vector<PaperFigure> loopFigures(const FigureHead& head, const PreparedScene& prepared,
                                     std::span<const RigidTransform> path, const PaperRunOptions& options) {
  const ErrorScene scene(prepared.meshes.scene, prepared.meshes.part, prepared.cutoff);
  const std::vector<double> hierarchies = hierarchyTimes(prepared.meshes);
  std::vector<LoopLane> lanes;
  for (ErrorMethodEntry& entry : judgedMethods()) {
    std::vector<double> times;
    std::unique_ptr<ErrorMethod> method;
    for (int i = 0; i < kPreparations; ++i) {
      method.reset();
      times.push_back(timeOf(BenchClock::Process, [&] { method = entry.make(scene); }));
      // The scene holds its hierarchies for it: it pays for them all the same.
      if (method->byteSize() == 0) times.back() += hierarchies[static_cast<std::size_t>(i)];
    }
    const bool isSlowOne = entry.name.starts_with("paper");
    lanes.push_back(
        {std::move(entry), isSlowOne ? options.slowStride : 1, std::move(method), std::move(times)});
  }
  ContactAnswer answer;
  for (std::size_t begin = 0; begin < path.size(); begin += options.block) {
    const std::size_t end = std::min(begin + options.block, path.size());
    for (LoopLane& lane : lanes) {
      for (std::size_t i = begin; i < end; ++i) {
        if (i % lane.stride != 0) continue;
        answer.clear();
        const double start = secondsBy(options.clock);
        lane.method->answer(path[i], answer);
        lane.times.push_back(secondsBy(options.clock) - start);
        lane.method->workAside(path[i]);
        lane.wholes.push_back(secondsBy(options.clock) - start);
      }
    }
  }
  std::vector<PaperFigure> figures;
  for (const LoopLane& lane : lanes) {
    figures.push_back(paperFigure(head, lane.entry.name, "loop [us]", lane.times, kMicro));
    figures.push_back(paperFigure(head, lane.entry.name, "loop [Hz]", inverse(lane.times)));
    figures.push_back(
        paperFigure(head, lane.entry.name, "loop and search beside it [us]", lane.wholes, kMicro));
    figures.push_back(paperFigure(head, lane.entry.name, "prepared in [s]", lane.prepared));
  }
  return figures;
}

/// The product's own tick in both modes: handle, query, forces, limits, snapshot.
std::vector<PaperFigure> tickFigures(const FigureHead& head, const PreparedScene& prepared,
                                     std::span<const RigidTransform> path, BenchClock clock) {
  std::vector<PaperFigure> figures;
  const auto bodies = solidScene(prepared.meshes.scene, prepared.meshes.part, path.front());
  for (const HapticMode mode : {HapticMode::Springs, HapticMode::Proxy}) {
    ServoParameters parameters;
    parameters.haptics.mode = mode;
    parameters.haptics.springs.cutoff = prepared.cutoff;
    FeelServo servo(bodies, parameters, ListArrival::InTime, clock);
    std::vector<double> times;
    for (const RigidTransform& pose : path) {
      servo.tick(pose, ServoLoop::kPeriod);
      times.push_back(servo.tickTime());
    }
    const std::string name = mode == HapticMode::Springs ? "springs' tick" : "proxy's tick";
    figures.push_back(paperFigure(head, name, "loop [us]", times, kMicro));
    figures.push_back(paperFigure(head, name, "loop [Hz]", inverse(times)));
  }
  return figures;
}

std::vector<PaperFigure> buildFigures(const FigureHead& head, const BenchScene& meshes) {
  std::vector<PaperFigure> figures;
  for (const auto& [name, rule] :
       {std::pair{"paper-spans", PaperRule::NormalSpans}, std::pair{"paper-cones", PaperRule::NormalCones}}) {
    figures.push_back(paperFigure(head, name, "build [s]", timeOf(BenchClock::Wall, [&, rule = rule] {
                                    const PaperHierarchy scene(meshes.scene, rule), part(meshes.part, rule);
                                  })));
  }
  figures.push_back(paperFigure(head, "nearfit", "build [s]", timeOf(BenchClock::Wall, [&] {
                                  const NormalConeTree scene = searchedTree(meshes.scene),
                                                       part = searchedTree(meshes.part);
                                })));
  return figures;
}

/// The counts at a row's pose itself.
std::vector<PaperFigure> poseFigures(const FigureHead& head, const PaperRow& row,
                                     const PreparedScene& scene) {
  const PaperRow::Printed& printed = row.printed.value();
  std::vector<PaperFigure> figures{
      paperFigure(head, "printed", "minima at the pose", static_cast<double>(printed.minima)),
      paperFigure(head, "printed", "loop [Hz]", printed.rate)};
  for (const MethodEntry& method : sweptMethods(true)) {
    if (method.kind == AnswerKind::Distance) continue;
    const Answer answer = method.make(scene)->query(row.pose);
    figures.push_back(
        paperFigure(head, method.name, "minima at the pose", static_cast<double>(answer.count)));
  }
  return figures;
}

constexpr std::array<double, 6> kCutoffs{0.005, 0.01, 0.02, 0.05, 0.1, 0.2};
constexpr std::array<std::size_t, 7> kTriangles{512, 2048, 8192, 32768, 131072, 393216, 1'000'000};

/// Of the bowl's inner wall: near enough that all around the lowest place is within the cutoff, far from conforming.
constexpr double kBallInBowl = 0.8;

/// So that no facets are parallel.
const glm::dquat kAnyTurn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, 3.0)));

/// Two lumpy bodies of as many triangles each.
BenchScene lumpyPair(std::size_t triangles) {
  const auto frequency = static_cast<std::uint32_t>(
      std::max(1.0, std::round(std::sqrt(static_cast<double>(triangles) / 2.0 / 20.0))));
  const TriangleMesh scene = organicMesh(frequency, 1), part = organicMesh(frequency, 2);
  return {"lumpy", test::transformed(scene, 1.0 / scene.bounds().diagonal()),
          test::transformed(part, 1.0 / part.bounds().diagonal()), std::nullopt, std::nullopt};
}

/// A ball near the bottom of a bowl, each with half of the triangles.
BenchScene ballInBowl(std::size_t triangles) {
  // 4 s r faces of the bowl and 2 s (2 r - 1) of the ball, s = 4 r: some 32 r^2.
  const auto rings =
      static_cast<std::uint32_t>(std::max(2.0, std::round(std::sqrt(static_cast<double>(triangles) / 32.0))));
  const std::uint32_t segments = 4 * rings;
  const TriangleMesh bowl = test::bowlMesh(1.0, 1.2, segments, rings),
                     ball = test::uvSphereMesh(kBallInBowl, segments, 2 * rings);
  const double scale = 1.0 / bowl.bounds().diagonal();
  // Off the axis, so that no minimum is there by symmetry alone.
  const glm::dvec3 low{0.03, 0.02, -0.9 * (1.0 - kBallInBowl)};
  return {"ball-bowl", test::transformed(bowl, scale), test::transformed(ball, scale),
          RigidTransform{kAnyTurn, scale * low}, 0.1 * (1.0 - kBallInBowl)};
}

const std::array<SweptBody, 2> kBodies{{{"lumpy", lumpyPair}, {"ball-bowl", ballInBowl}}};

}  // namespace

std::vector<ErrorMethodEntry> judgedMethods() {
  constexpr std::array<const char*, 6> kNames{"exact cold",  "exact tracked", "exact grouped",
                                              "paper spans", "paper cones",   "FCL global distance"};
  std::vector<ErrorMethodEntry> methods;
  for (ErrorMethodEntry& entry : allErrorMethods()) {
    if (std::find(kNames.begin(), kNames.end(), entry.name) != kNames.end())
      methods.push_back(std::move(entry));
  }
  return methods;
}

std::vector<RigidTransform> pathOfRow(const PreparedScene& scene, std::size_t poses, std::uint64_t seed) {
  HandPathOptions options;
  options.poses = poses;
  options.seed = seed;
  return makePath(scene, options);
}

std::vector<PaperFigure> appendixFigures(const PaperRow& row, BenchScene meshes,
                                         const PaperRunOptions& options) {
  meshes.range = kRowRange * meshes.size();
  const FigureHead head{"appendix", meshes.name, ""};
  std::vector<PaperFigure> figures = buildFigures(head, meshes);
  const PreparedScene scene(std::move(meshes), row.cutoffFraction);
  const std::vector<RigidTransform> path = pathOfRow(scene, options.poses, options.seed);
  const auto append = [&figures](std::vector<PaperFigure> more) {
    figures.insert(figures.end(), more.begin(), more.end());
  };
  append(poseFigures(head, row, scene));
  append(queryFigures(head, scene, sweptMethods(true), path, options));
  append(loopFigures(head, scene, path, options));
  append(tickFigures(head, scene, path, options.clock));
  return figures;
}

std::vector<PaperFigure> judgedTimes(const PaperRow& row, BenchScene meshes, const PaperRunOptions& options) {
  meshes.range = kRowRange * meshes.size();
  const FigureHead head{"judge", meshes.name, ""};
  const PreparedScene scene(std::move(meshes), row.cutoffFraction);
  return loopFigures(head, scene, pathOfRow(scene, options.poses, options.seed), options);
}

std::span<const double> sweptCutoffs() {
  return kCutoffs;
}

std::vector<PaperFigure> cutoffFigures(const PaperRow& row, const BenchScene& meshes,
                                       const PaperRunOptions& options) {
  BenchScene moved = meshes;
  moved.range = kRowRange * meshes.size();
  std::vector<PaperFigure> figures;
  std::vector<RigidTransform> path;
  for (const double fraction : kCutoffs) {
    const PreparedScene scene(moved, fraction);
    // The same path for all: times then differ by the cutoff alone.
    if (path.empty())
      path = pathOfRow(PreparedScene(moved, row.cutoffFraction), options.sweepPoses, options.seed);
    const FigureHead head{"cutoff", meshes.name, fmt::format("{:g}", fraction)};
    const std::vector<PaperFigure> more = queryFigures(head, scene, sweptMethods(true), path, options);
    figures.insert(figures.end(), more.begin(), more.end());
  }
  return figures;
}

std::span<const SweptBody> sweptBodies() {
  return kBodies;
}

std::span<const std::size_t> sweptTriangles() {
  return kTriangles;
}

std::vector<PaperFigure> trianglesFigures(const SweptBody& body, std::size_t triangles,
                                          std::size_t maxPaperTriangles, const PaperRunOptions& options) {
  const PreparedScene scene(body.make(triangles), kUsualCutoffFraction);
  const std::size_t has = scene.meshes.scene.triangles().size() + scene.meshes.part.triangles().size();
  const FigureHead head{"triangles", body.name, fmt::format("{}", has)};
  const std::vector<RigidTransform> path = pathOfRow(scene, options.sweepPoses, options.seed);
  return queryFigures(head, scene, sweptMethods(has <= maxPaperTriangles), path, options);
}

}  // namespace nearfit::bench
