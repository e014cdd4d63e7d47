#include "core/verdict/scene_check.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/math/box_pairs.h"
#include "core/mesh/check/crossing_triangles.h"
#include "core/parallel/low_priority.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/parallel/work_spaces.h"
#include "core/proximity/overlap/containment.h"
#include "core/proximity/query/broad_phase.h"
#include "core/proximity/tracking/lmd_set.h"
#include "core/verdict/pair_separation.h"

namespace nearfit {
namespace {

/// Share of the progress that building hierarchies takes, if any are missing.
constexpr double kBuilding = 0.5;

/// Bound on pairs of triangles looked at for curves, and of edges and triangles that meet for a volume: some seconds.
constexpr std::size_t kMaxCurvePairs = 1'000'000, kMaxVolumePairs = 1'000'000;

/// Bound on the points looked at for the interference of a press fit: about a second.
constexpr std::uint64_t kMaxDepthSamples = 1'000'000;

/// Properties of a mesh that take time by the number of its triangles, found when first needed and kept for all pairs.
/// Thread-safe.
class CheckedShape {
 public:
  explicit CheckedShape(const PartGeometry& geometry) : geometry_(geometry) {}

  const TriangleMesh& mesh() const { return geometry_.tree().mesh(); }
  ComponentsOnDemand& components() noexcept { return components_; }
  /// Null if the body is not convex.
  const ConvexBody* convex() {
    std::call_once(convexOnce_, [&] { convex_ = convexBodyOf(mesh()); });
    return convex_ ? &*convex_ : nullptr;
  }
  /// True if the mesh crosses itself, or may.
  bool crossesItself() {
    std::call_once(crossingOnce_, [&] {
      const CrossingTriangles crossing = findCrossingTriangles(mesh(), 1);
      crossesItself_ = !crossing.pairs.empty() || !crossing.isComplete;
    });
    return crossesItself_;
  }

 private:
  const PartGeometry& geometry_;
  ComponentsOnDemand components_;
  std::once_flag convexOnce_, crossingOnce_;
  std::optional<ConvexBody> convex_;
  bool crossesItself_ = false;
};

/// Work space of one thread.
struct CheckWork {
  explicit CheckWork(std::size_t maxMinima) : minima(maxMinima) {}
  LmdCollector minima;
  LmdScratch scratch;
};

/// Two parts, by their indices in the request.
struct NearPair {
  std::size_t part, other;
};

/// Everything that the finding of a pair depends on: geometries by index, relative pose and allowed interference by
/// their bits.
using PairKey = std::array<std::uint64_t, 10>;

RigidTransform relativePoseOf(const CheckedPart& part, const CheckedPart& other) {
  return (other.worldFromPart.inverse() * part.worldFromPart).normalized();
}

MeshArrays arraysOf(const std::vector<glm::dvec3>& vertices, const TriangleMesh& mesh) {
  return {vertices, mesh.triangles()};
}

std::vector<glm::dvec3> placedVertices(const TriangleMesh& mesh, const RigidTransform& pose) {
  std::vector<glm::dvec3> placed;
  placed.reserve(mesh.vertices().size());
  for (const glm::dvec3& p : mesh.vertices())
    placed.push_back(pose.applyToPoint(p));
  return placed;
}

class SceneChecker {
 public:
  SceneChecker(const SceneCheckRequest& request, const ProgressCallback& progress)
      : request_(request),
        progress_(progress),
        rules_(request.rules, ruledParts(request)),
        works_([maxMinima = request.maxMinima > 0 ? request.maxMinima : kMostMinima] {
          return std::make_unique<CheckWork>(maxMinima);
        }) {
    if (!std::isfinite(request.threshold) || request.threshold < 0.0)
      throw UsageError("check", fmt::format("{} m is not a valid threshold", request.threshold),
                       "give a length of at least 0");
    result_.threshold = request.threshold;
    result_.rules = request.rules;
    for (const CheckedPart& part : request.parts) {
      result_.parts.push_back(part.id);
      const auto [known, isNew] = shapeOf_.emplace(part.geometry.get(), shapes_.size());
      if (isNew) shapes_.push_back(std::make_unique<CheckedShape>(*part.geometry));
    }
  }

  SceneCheck run() {
    const double start = buildHierarchies();
    const std::vector<NearPair> pairs = findNearPairs();
    std::vector<NearPair> examples;
    const std::vector<std::size_t> exampleOf = groupPairs(pairs, examples);
    std::vector<std::optional<PairFinding>> found(examples.size());
    const ProgressCallback rest = stageCallback(progress_, start, 1.0);
    SharedProgress shared(rest, static_cast<double>(std::max<std::size_t>(examples.size(), 1)));
    parallelFor(examples.size(), [&](std::size_t i) {
      works_.with([&](CheckWork& work) { found[i] = findingOf(examples[i], work, shared); });
      shared.add(1.0);
    });
    // Each example is given to the last pair that looks like it, so that minima are not in memory twice.
    std::vector<std::size_t> lastOf(examples.size());
    for (std::size_t i = 0; i < pairs.size(); ++i)
      lastOf[exampleOf[i]] = i;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      std::optional<PairFinding>& example = found[exampleOf[i]];
      if (!example) continue;
      const bool isLast = lastOf[exampleOf[i]] == i;
      result_.findings.push_back(placed(isLast ? std::move(*example) : *example, pairs[i]));
    }
    return std::move(result_);
  }

 private:
  static std::vector<RuledPart> ruledParts(const SceneCheckRequest& request) {
    std::vector<RuledPart> parts;
    for (const CheckedPart& part : request.parts)
      parts.push_back(part.ruled);
    return parts;
  }

  std::vector<PartGeometryPtr> distinctGeometries() const {
    std::vector<PartGeometryPtr> geometries(shapes_.size());
    for (const CheckedPart& part : request_.parts)
      geometries[shapeOf_.at(part.geometry.get())] = part.geometry;
    return geometries;
  }

  /// Returns the progress after it.
  double buildHierarchies() {
    const std::vector<PartGeometryPtr> geometries = distinctGeometries();
    if (areHierarchiesReady(geometries)) return 0.0;
    prepareHierarchies(geometries, stageCallback(progress_, 0.0, kBuilding));
    return kBuilding;
  }

  /// The pairs whose boxes are within the threshold and that no rule leaves out, in ascending order.
  std::vector<NearPair> findNearPairs() {
    BoxPairs boxes(request_.parts.size());
    // Padding beyond the rounding of half the threshold.
    const double half = 0.5 * request_.threshold * (1.0 + 1e-9) + std::numeric_limits<double>::min();
    for (const CheckedPart& part : request_.parts) {
      Aabb box = boundsOf(part.geometry->tree().mesh().bounds(), part.worldFromPart);
      box.lower -= half;
      box.upper += half;
      boxes.add(box);
    }
    boxes.build();
    std::vector<NearPair> all;
    boxes.forEachPair(
        [&all](std::uint32_t i, std::uint32_t k) { all.push_back({std::min(i, k), std::max(i, k)}); });
    std::ranges::sort(all, {}, [](const NearPair& p) { return std::pair(p.part, p.other); });
    std::vector<NearPair> pairs;
    for (const NearPair& pair : all) {
      if (const auto rule = rules_.leavingOut(pair.part, pair.other)) {
        result_.leftOut.push_back({idsOf(pair), *rule});
      } else {
        pairs.push_back(pair);
      }
    }
    return pairs;
  }

  PartPair idsOf(const NearPair& pair) const {
    return {request_.parts[pair.part].id, request_.parts[pair.other].id};
  }

  /// Finds pairs that look alike: one example of each, and for each pair the index of its example.
  std::vector<std::size_t> groupPairs(const std::vector<NearPair>& pairs,
                                      std::vector<NearPair>& examples) const {
    std::map<PairKey, std::size_t> known;
    std::vector<std::size_t> exampleOf;
    exampleOf.reserve(pairs.size());
    for (const NearPair& pair : pairs) {
      const auto [at, isNew] = known.emplace(keyOf(pair), examples.size());
      if (isNew) examples.push_back(pair);
      exampleOf.push_back(at->second);
    }
    return exampleOf;
  }

  PairKey keyOf(const NearPair& pair) const {
    const CheckedPart &part = request_.parts[pair.part], &other = request_.parts[pair.other];
    const RigidTransform pose = relativePoseOf(part, other);
    const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
    return {shapeOf_.at(part.geometry.get()),
            shapeOf_.at(other.geometry.get()),
            bits(rules_.allowedInterference(pair.part, pair.other)),
            bits(pose.rotation.w),
            bits(pose.rotation.x),
            bits(pose.rotation.y),
            bits(pose.rotation.z),
            bits(pose.translation.x),
            bits(pose.translation.y),
            bits(pose.translation.z)};
  }

  /// The finding of an example, in the frame of the other part; no value if the parts are clear.
  std::optional<PairFinding> findingOf(const NearPair& pair, CheckWork& work, SharedProgress& shared) {
    const CheckedPart &part = request_.parts[pair.part], &other = request_.parts[pair.other];
    const RigidTransform pose = relativePoseOf(part, other);
    const double within = std::max(request_.threshold, touchTolerance(*part.geometry, *other.geometry));
    const std::optional<PairSeparation> separation =
        separationOf(*part.geometry, *other.geometry, pose, within, work.scratch,
                     {shapeAt(pair.part).components(), shapeAt(pair.other).components()});
    if (!separation) return std::nullopt;
    PairFinding finding;
    finding.verdict = verdictOf(*separation);
    finding.distance = separation->distance;
    finding.partPoint = separation->partPoint;
    finding.otherPoint = separation->otherPoint;
    if (finding.verdict >= PairVerdict::Clash) {
      finding.clash = measure(pair, pose, finding.verdict, work, shared);
    } else if (separation->overlap == InterferenceKind::Disjoint && request_.threshold > 0.0) {
      addMinima(*part.geometry, *other.geometry, pose, work, finding);
    }
    return finding;
  }

  void addMinima(const PartGeometry& part, const PartGeometry& other, const RigidTransform& pose,
                 CheckWork& work, PairFinding& finding) const {
    const LmdSet set = work.minima.collect(other.tree(), part.tree(), pose, request_.threshold);
    finding.isEveryMinimum = set.isComplete;
    finding.minima.reserve(set.lmds.size());
    for (const Lmd& lmd : set.lmds)
      finding.minima.push_back(
          {lmd.partPoint, lmd.scenePoint, lmd.distance, lmd.isRegion, lmd.isBlocked, lmd.isMarginal});
  }

  ClashMeasures measure(const NearPair& pair, const RigidTransform& pose, PairVerdict verdict,
                        CheckWork& work, SharedProgress& shared) {
    CheckedShape &part = shapeAt(pair.part), &other = shapeAt(pair.other);
    // CGAL, which calls this, must not be left by an exception of ours.
    const GoOn goOn = [&shared] {
      try {
        shared.add(0.0);
        return true;
      } catch (const Cancelled&) {
        return false;
      }
    };
    ClashMeasures measures;
    const std::vector<glm::dvec3> vertices = placedVertices(part.mesh(), pose);
    const MeshArrays moved = arraysOf(vertices, part.mesh());
    const MeshArrays fixed{other.mesh().vertices(), other.mesh().triangles()};
    if (verdict == PairVerdict::Clash) {
      IntersectionCurves curves = findIntersectionCurves(fixed, moved, kMaxCurvePairs, goOn);
      measures.curves = std::move(curves.polylines);
      measures.isEveryCurve = curves.isComplete;
    }
    measureVolume(part, other, moved, fixed, goOn, measures);
    const NormalConeTree &partTree = treeAt(pair.part), &otherTree = treeAt(pair.other);
    if (request_.hasDepths) {
      const DepthBody scene{otherTree, other.convex()}, moving{partTree, part.convex()};
      const auto depth = findClashDepth(scene, moving, pose, work.scratch, {.goOn = goOn});
      if (depth) {
        measures.freeing = depth->translation;
        measures.isDepthExact = depth->isExact;
      }
    }
    const double allowed = rules_.allowedInterference(pair.part, pair.other);
    if (allowed > 0.0)
      measures.interference = findSurfaceDepth(otherTree, partTree, pose, allowed, kMaxDepthSamples, goOn);
    return measures;
  }

  void measureVolume(CheckedShape& part, CheckedShape& other, const MeshArrays& moved,
                     const MeshArrays& fixed, const GoOn& goOn, ClashMeasures& measures) const {
    const auto isOpen = [](const CheckedShape& shape) { return !shape.mesh().topology().isClosed(); };
    if (moved.triangles.size() + fixed.triangles.size() > request_.maxVolumeTriangles) {
      measures.volumeProblem = VolumeProblem::TooLarge;
    } else if (isOpen(part) || isOpen(other)) {
      const bool hasBorder = part.mesh().topology().openEdges + other.mesh().topology().openEdges > 0;
      measures.volumeProblem = hasBorder ? VolumeProblem::Open : VolumeProblem::NotManifold;
    } else if (part.crossesItself() || other.crossesItself()) {
      measures.volumeProblem = VolumeProblem::CrossesItself;
    } else {
      const IntersectionVolume shared =
          findIntersectionVolume(fixed, moved, request_.maxVolumeTriangles, kMaxVolumePairs, goOn);
      measures.volume = shared.volume;
      measures.volumeProblem = shared.problem;
    }
  }

  CheckedShape& shapeAt(std::size_t part) {
    return *shapes_[shapeOf_.at(request_.parts[part].geometry.get())];
  }
  const NormalConeTree& treeAt(std::size_t part) const { return request_.parts[part].geometry->tree(); }

  /// The finding of a pair that looks like the example, in the world.
  PairFinding placed(PairFinding finding, const NearPair& pair) const {
    const RigidTransform& world = request_.parts[pair.other].worldFromPart;
    finding.pair = idsOf(pair);
    finding.partPoint = world.applyToPoint(finding.partPoint);
    finding.otherPoint = world.applyToPoint(finding.otherPoint);
    for (FoundMinimum& minimum : finding.minima) {
      minimum.partPoint = world.applyToPoint(minimum.partPoint);
      minimum.otherPoint = world.applyToPoint(minimum.otherPoint);
    }
    if (finding.clash) {
      for (std::vector<glm::dvec3>& curve : finding.clash->curves) {
        for (glm::dvec3& point : curve)
          point = world.applyToPoint(point);
      }
      if (finding.clash->freeing)
        finding.clash->freeing->direction = world.applyToVector(finding.clash->freeing->direction);
    }
    finding.allowedBy = rules_.allowing(pair.part, pair.other, finding.verdict, depthOf(finding));
    return finding;
  }

  /// Max depth of a clash, as far as is known [m].
  static double depthOf(const PairFinding& finding) {
    if (!finding.clash) return 0.0;
    const double freeing = finding.depth().value_or(std::numeric_limits<double>::infinity());
    return finding.clash->interference ? std::min(freeing, finding.clash->interference->most) : freeing;
  }

  const SceneCheckRequest& request_;
  const ProgressCallback& progress_;
  PairRules rules_;
  WorkSpaces<CheckWork> works_;
  std::map<const PartGeometry*, std::size_t> shapeOf_;
  std::vector<std::unique_ptr<CheckedShape>> shapes_;
  SceneCheck result_;
};

}  // namespace

SceneCheckRequest sceneCheckRequest(const Scene& scene, double threshold) {
  SceneCheckRequest request;
  request.threshold = threshold;
  request.rules = scene.pairRules();
  for (const Scene::PartPtr& part : scene.parts()) {
    if (part->isVisible && hasTriangles(*part))
      request.parts.push_back({part->id, {part->name, part->group}, part->geometry, part->worldFromPart});
  }
  return request;
}

const char* textOf(VolumeProblem problem) noexcept {
  switch (problem) {
    case VolumeProblem::None:
      return "";
    case VolumeProblem::Open:
      return "a mesh is not closed";
    case VolumeProblem::NotManifold:
      return "edges of a mesh have more than two faces";
    case VolumeProblem::NoArea:
      return "a mesh has triangles without area";
    case VolumeProblem::InsideOut:
      return "a mesh is inside out";
    case VolumeProblem::CrossesItself:
      return "a mesh crosses itself";
    case VolumeProblem::TooLarge:
      return "there are too many triangles";
    case VolumeProblem::Failed:
      return "its construction failed";
    case VolumeProblem::Stopped:
      break;
  }
  return "it was stopped";
}

std::size_t SceneCheck::checkedPairs() const noexcept {
  const std::size_t all = parts.size() * (parts.size() - std::min<std::size_t>(parts.size(), 1)) / 2;
  return all - leftOut.size();
}

std::size_t SceneCheck::count(PairVerdict verdict) const noexcept {
  if (verdict == PairVerdict::Clear) return checkedPairs() - findings.size();
  return static_cast<std::size_t>(std::ranges::count(findings, verdict, &PairFinding::verdict));
}

std::size_t SceneCheck::forbidden() const noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(findings, &PairFinding::isForbidden));
}

SceneCheck checkScene(const SceneCheckRequest& request, const ProgressCallback& progress) {
  if (!request.isLowPriority) return SceneChecker(request, progress).run();
  // A thread cannot get its priority back, so that the caller's stays as it is.
  SceneCheck result;
  std::exception_ptr failure;
  std::thread runner([&] {
    lowerThreadPriority();
    try {
      result = SceneChecker(request, progress).run();
    } catch (...) {
      failure = std::current_exception();
    }
  });
  runner.join();
  if (failure) std::rethrow_exception(failure);
  return result;
}

}  // namespace nearfit
