#include "core/report/clearance_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/math/round_number.h"
#include "core/math/tolerances.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/proximity/overlap/containment.h"
#include "core/proximity/query/broad_phase.h"
#include "core/proximity/surface/point_distance.h"
#include "core/proximity/surface/surface_distance.h"
#include "core/report/clearance_histogram.h"

namespace nearfit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoDistance = std::numeric_limits<double>::quiet_NaN();

/// Samples whose search uses what the search of the one before found. Fixed, so that results do not depend on threads.
constexpr std::size_t kChunk = 512;
/// Share of a bound on a distance that rounding leaves.
constexpr double kSure = 1.0 - 1e-9;

/// Progress when hierarchies are built, and when surfaces are sampled.
constexpr double kPrepared = 0.3, kSampled = 0.4;

/// Distance between two boxes [m].
double gapOf(const Aabb& a, const Aabb& b) noexcept {
  return glm::length(glm::max(glm::max(a.lower - b.upper, b.lower - a.upper), glm::dvec3(0.0)));
}

Aabb grown(Aabb box, double by) noexcept {
  box.lower -= glm::dvec3(by);
  box.upper += glm::dvec3(by);
  return box;
}

bool hasTriangles(const PartGeometryPtr& geometry) {
  return geometry && !geometry->mesh.triangles().empty();
}

/// Parts that are measured as one, the leading one first.
using Subject = std::vector<const MeasuredPart*>;

Subject subjectOf(const ClearanceMapRequest& request) {
  Subject subject;
  for (const PartId id : request.subject) {
    const auto part = std::ranges::find(request.parts, id, &MeasuredPart::id);
    if (part == request.parts.end() || !hasTriangles(part->geometry)) {
      subject.clear();
      break;
    }
    subject.push_back(&*part);
  }
  if (subject.empty())
    throw UsageError("clearance map", "there is no such part with a surface", "choose a part of the scene");
  return subject;
}

bool isOf(const Subject& subject, const MeasuredPart& part) {
  return std::ranges::find(subject, &part) != subject.end();
}

void checkRange(double range) {
  if (!(range >= 0.0) || !std::isfinite(range))
    throw UsageError("clearance map", fmt::format("{} m is not a valid range", range),
                     "give a length greater than 0");
}

RigidTransform relativePose(const MeasuredPart& to, const MeasuredPart& from) noexcept {
  return (to.worldFromPart.inverse() * from.worldFromPart).normalized();
}

/// Box of a part in the frame of another one.
Aabb boxIn(const MeasuredPart& frame, const MeasuredPart& part) noexcept {
  return boundsOf(part.geometry->mesh.bounds(), relativePose(frame, part));
}

double sizeOf(const MeasuredPart& part) noexcept {
  return part.geometry->mesh.bounds().diagonal();
}

/// Box of the subject in the frame of a part [m].
Aabb boxIn(const MeasuredPart& frame, const Subject& subject) noexcept {
  Aabb box;
  for (const MeasuredPart* part : subject) {
    const Aabb one = part == &frame ? part->geometry->mesh.bounds() : boxIn(frame, *part);
    box.add(one.lower);
    box.add(one.upper);
  }
  return box;
}

double sizeOf(const Subject& subject) noexcept {
  return boxIn(*subject.front(), subject).diagonal();
}

/// A range over the distance that it is chosen by: half as much again, so that colours beyond it show too.
constexpr double kRangeOfDistance = 1.5;

/// The range that is searched for an automatic one, before rounding [m].
double searchedRange(double size, double leastDistance) noexcept {
  constexpr double kOfSize = 0.05;
  const double least = std::isfinite(leastDistance) ? leastDistance : 0.0;
  return std::max({kOfSize * size, kRangeOfDistance * least, std::numeric_limits<double>::min()});
}

/// A range that was found before, if it is not much more than the wanted one, else that, rounded up.
double keptOrRounded(double wanted, double kept) noexcept {
  constexpr double kSlack = 4.0;
  const bool isKept = kept > 0.0 && wanted <= kept && kSlack * wanted >= kept;
  return isKept ? kept : roundedUp(wanted);
}

}  // namespace

/// A part as others are measured against it, in its own frame.
class ClearanceMapper::Target {
 public:
  explicit Target(const PartGeometryPtr& geometry)
      : mesh_(geometry->tree(), nullptr),
        components_(piecesOf(mesh_.mesh())),
        solid_(mesh_, components_),
        distance_(mesh_),
        bounds_(mesh_.mesh().bounds()) {}
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  const PointDistance& distance() const noexcept { return distance_; }
  /// True if the point, which is not on the surface, is within what closed components enclose.
  bool contains(const glm::dvec3& point) const { return solid_.contains(point); }
  const Aabb& bounds() const noexcept { return bounds_; }
  double size() const noexcept { return mesh_.tree().size(); }

 private:
  PlacedMesh mesh_;
  MeshComponents components_;
  PlacedSolid solid_;
  PointDistance distance_;
  Aabb bounds_;
};

namespace {

/// The parts of ClearanceMapper::Target that are needed here; a template, as that class is private.
template <class Target>
struct PlacedTarget {
  PartId id{};
  std::shared_ptr<const Target> target;
  RigidTransform targetFromPart, worldFromTarget;
};

/// The search of one sample after the other against the same targets.
template <class Target>
class SampleSearch {
 public:
  /// @param targets  Near enough to matter.
  SampleSearch(std::vector<const PlacedTarget<Target>*> targets, double range)
      : targets_(std::move(targets)), before_(targets_.size()), range_(range) {}

  struct Result {
    double distance = kNoDistance;
    PartId nearest{};
    glm::dvec3 nearestPoint{0.0};  ///< In the world [m].
  };

  /// @param point  In the part's frame [m].
  Result at(const glm::dvec3& point) {
    Result best;
    // A distance of just the range counts.
    double least = std::nextafter(range_, kInfinity);
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      const PlacedTarget<Target>& placed = *targets_[i];
      const Found found =
          signedDistance(placed, before_[i], placed.targetFromPart.applyToPoint(point), least);
      if (!(found.distance < least)) continue;
      least = found.distance;
      best = {least, placed.id, placed.worldFromTarget.applyToPoint(found.point)};
    }
    return best;
  }

 private:
  /// Distance of the sample before to one target.
  struct Before {
    std::uint32_t triangle = NearestPoint::kNone;
    glm::dvec3 point{0.0};  ///< The sample, in the target's frame [m].
    /// The surface is no nearer to it [m]; 0 if it is not known on which side it is.
    double clear = 0.0;
    bool isInside = false;
  };
  struct Found {
    double distance = kInfinity;
    glm::dvec3 point{0.0};
  };

  /// @param least  Distances that are not below it do not matter; depths do, unless it is a greater depth.
  Found signedDistance(const PlacedTarget<Target>& placed, Before& before, const glm::dvec3& point,
                       double least) {
    const Target& target = *placed.target;
    const double outside = gapOf(target.bounds(), {point, point});
    if (outside > 0.0 && outside >= least) {
      before = {before.triangle, point, outside, false};
      return {};
    }
    const double within = least > 0.0 ? least : std::nextafter(range_, kInfinity);
    NearestPoint nearest = target.distance().nearest(point, within, before.triangle);
    const double clear = nearest.isFound() ? nearest.distance : within;
    // On the surface to rounding: neither side.
    if (clear <= kDistanceTolerance * (target.size() + glm::length(point))) {
      before = {nearest.triangle, point, 0.0, false};
      return {clear, nearest.point};
    }
    const bool isInside = outside > 0.0 ? false : isWithin(target, before, point);
    if (isInside && !nearest.isFound())
      nearest = target.distance().nearest(point, kInfinity, before.triangle);
    before = {nearest.isFound() ? nearest.triangle : before.triangle, point, clear, isInside};
    return {isInside ? -nearest.distance : nearest.distance, nearest.point};
  }

  /// No surface is between two points that are nearer to each other than to it.
  static bool isWithin(const Target& target, const Before& before, const glm::dvec3& point) {
    if (glm::distance(point, before.point) < kSure * before.clear) return before.isInside;
    return target.contains(point);
  }

  std::vector<const PlacedTarget<Target>*> targets_;
  std::vector<Before> before_;
  const double range_;
};

/// Fills in the clearances of a chunk of samples, from `begin` to before `end`.
template <class Target>
void measureChunk(MappedSurface& mapped, std::span<const PlacedTarget<Target>> targets, double range,
                  std::size_t begin, std::size_t end) {
  const std::vector<glm::dvec3>& points = mapped.surface->points;
  Aabb box;
  for (std::size_t i = begin; i < end; ++i)
    box.add(points[i]);
  const double reach = range + 0.5 * box.diagonal();
  std::vector<const PlacedTarget<Target>*> near;
  for (const PlacedTarget<Target>& placed : targets) {
    const glm::dvec3 centre = placed.targetFromPart.applyToPoint(box.centre());
    if (kSure * gapOf(placed.target->bounds(), {centre, centre}) <= reach) near.push_back(&placed);
  }
  if (near.empty()) return;
  SampleSearch<Target> search(std::move(near), range);
  for (std::size_t i = begin; i < end; ++i) {
    const auto found = search.at(points[i]);
    mapped.distances[i] = found.distance;
    mapped.nearest[i] = found.nearest;
    mapped.nearestPoints[i] = found.nearestPoint;
  }
}

template <class Target>
void measure(MappedSurface& mapped, std::span<const PlacedTarget<Target>> targets, double range,
             bool isParallel, SharedProgress& progress) {
  const std::size_t count = mapped.surface->points.size();
  mapped.distances.assign(count, kNoDistance);
  mapped.nearest.assign(count, PartId{});
  mapped.nearestPoints.assign(count, glm::dvec3(0.0));
  const auto work = [&](std::size_t chunk) {
    const std::size_t begin = chunk * kChunk, end = std::min(count, begin + kChunk);
    measureChunk(mapped, targets, range, begin, end);
    progress.add(static_cast<double>(end - begin));
  };
  const std::size_t chunks = (count + kChunk - 1) / kChunk;
  if (isParallel) return parallelFor(chunks, work);
  for (std::size_t chunk = 0; chunk < chunks; ++chunk)
    work(chunk);
}

/// Least distance of the subject to the others [m], 0 if surfaces meet; infinity if none is below `within`.
double leastDistanceOf(const ClearanceMapRequest& request, const Subject& subject, double within,
                       const ProgressCallback& progress) {
  struct Pair {
    double gap;
    const MeasuredPart *part, *other;
  };
  std::vector<Pair> pairs;
  for (const MeasuredPart* part : subject) {
    for (const MeasuredPart& other : request.parts) {
      if (isOf(subject, other)) continue;
      pairs.push_back({gapOf(part->geometry->mesh.bounds(), boxIn(*part, other)), part, &other});
    }
  }
  std::ranges::stable_sort(pairs, {}, &Pair::gap);
  LmdScratch scratch(1);
  double least = kInfinity;
  for (const auto& [gap, part, other] : pairs) {
    if (kSure * gap >= std::min(least, within)) break;
    prepareHierarchies(std::vector{part->geometry, other->geometry}, progress);
    const SurfaceDistance found =
        leastSurfaceDistance(other->geometry->tree(), part->geometry->tree(), relativePose(*other, *part),
                             std::min(least, within), scratch, std::numeric_limits<std::uint64_t>::max());
    least = std::min(least, found.distance);
  }
  return least;
}

/// The other parts whose box is within the range of that of a part of the subject.
std::vector<const MeasuredPart*> partsNear(const ClearanceMapRequest& request, const Subject& subject,
                                           double range) {
  std::vector<const MeasuredPart*> near;
  for (const MeasuredPart& other : request.parts) {
    const auto isNear = [&](const MeasuredPart* part) {
      return kSure * gapOf(part->geometry->mesh.bounds(), boxIn(*part, other)) <= range;
    };
    if (!isOf(subject, other) && std::ranges::any_of(subject, isNear)) near.push_back(&other);
  }
  return near;
}

/// The range of a map whose range is automaticRange(), by the distances found: see ClearanceMapRequest::range.
double narrowedRange(const ClearanceMap& map, double size, double kept) {
  // Where all that is near is within a hundredth, rounding in meshes is part of it.
  constexpr double kMinOfSearched = 0.01;
  const double searched = searchedRange(size, map.leastDistance);
  const std::optional<double> median =
      AreaByClearance(map.subject()).median(std::nextafter(kContactDistance, kInfinity), searched);
  if (!median) return map.range;
  const double least = std::max(kMinOfSearched * searched, kRangeOfDistance * map.leastDistance);
  const double wanted = std::clamp(kRangeOfDistance * *median, std::min(least, searched), searched);
  return std::min(map.range, keptOrRounded(wanted, kept));
}

/// Leaves out what is beyond a range.
void narrow(ClearanceMap& map, double range) {
  map.range = range;
  for (MappedSurface& mapped : map.surfaces) {
    for (std::size_t i = 0; i < mapped.distances.size(); ++i) {
      if (!(mapped.distances[i] > range)) continue;
      mapped.distances[i] = kNoDistance;
      mapped.nearest[i] = PartId{};
      mapped.nearestPoints[i] = glm::dvec3(0.0);
    }
  }
}

}  // namespace

std::size_t ClearanceMap::samples() const noexcept {
  std::size_t count = 0;
  for (const MappedSurface& mapped : surfaces)
    count += mapped.surface->points.size();
  return count;
}

const MappedSurface* ClearanceMap::find(PartId part) const noexcept {
  const auto found = std::ranges::find(surfaces, part, &MappedSurface::part);
  return found == surfaces.end() ? nullptr : &*found;
}

std::vector<PartId> mapSubject(const Scene& scene, const std::vector<PartId>& selected) {
  const std::vector<PartId> inHand = scene.movingParts();
  const bool isInHand =
      selected.empty() || (selected.size() == inHand.size() && std::ranges::all_of(selected, [&](PartId id) {
                             return std::ranges::find(inHand, id) != inHand.end();
                           }));
  std::vector<PartId> subject = isInHand ? inHand : std::vector{selected.back()};
  const bool isAlone = subject.size() == 1;
  std::erase_if(subject, [&](PartId id) {
    const Part* part = scene.find(id);
    return part == nullptr || !hasTriangles(part->geometry) || (!isAlone && !part->isVisible);
  });
  return subject;
}

ClearanceMapRequest clearanceMapRequest(const Scene& scene, PartId subject, double range, bool hasNearParts) {
  return clearanceMapRequest(scene, std::vector{subject}, range, hasNearParts);
}

ClearanceMapRequest clearanceMapRequest(const Scene& scene, const std::vector<PartId>& subject, double range,
                                        bool hasNearParts) {
  checkRange(range);
  ClearanceMapRequest request;
  request.range = range;
  request.hasNearParts = hasNearParts;
  const auto isAlone = [&](PartId id) { return subject.size() == 1 && subject.front() == id; };
  for (const Scene::PartPtr& part : scene.parts()) {
    if ((isAlone(part->id) || part->isVisible) && hasTriangles(part->geometry))
      request.parts.push_back({part->id, part->geometry, part->worldFromPart});
  }
  for (const PartId id : subject) {
    if (std::ranges::find(request.parts, id, &MeasuredPart::id) != request.parts.end())
      request.subject.push_back(id);
  }
  subjectOf(request);
  return request;
}

ClearanceMap ClearanceMapper::map(const ClearanceMapRequest& request, const ProgressCallback& progress) {
  const Subject subject = subjectOf(request);
  checkRange(request.range);
  const ProgressCallback waiting = stageCallback(progress, 0.0, 0.0);
  ClearanceMap map;
  const bool isAutomatic = request.range == 0.0;
  const double within = isAutomatic ? kInfinity : std::nextafter(request.range, kInfinity);
  map.leastDistance = leastDistanceOf(request, subject, within, waiting);
  map.range =
      isAutomatic ? automaticRange(sizeOf(subject), map.leastDistance, request.keptRange) : request.range;
  const std::vector<const MeasuredPart*> near = partsNear(request, subject, map.range);
  std::vector<PartGeometryPtr> geometries;
  for (const Subject& parts : {subject, near})
    for (const MeasuredPart* part : parts)
      geometries.push_back(part->geometry);
  prepareHierarchies(geometries, stageCallback(progress, 0.0, kPrepared));

  const double spacing = sampleSpacing(map.range, sizeOf(subject));
  const std::size_t each = request.maxSamples / (subject.size() + (request.hasNearParts ? near.size() : 0));
  const auto add = [&map](const MeasuredPart& part, std::shared_ptr<const SampledSurface> surface) {
    map.isCoarse = map.isCoarse || surface->isCoarse;
    map.surfaces.push_back({part.id, part.worldFromPart, std::move(surface), {}, {}, {}});
  };
  const ProgressCallback sampling = stageCallback(progress, kPrepared, kPrepared);
  keepSamples(subject);
  map.subjectCount = subject.size();
  // Small parts of a large body are sampled as finely as alone.
  for (const MeasuredPart* part : subject)
    add(*part, subjectSurface(part->geometry, sampleSpacing(map.range, sizeOf(*part)), each, sampling));
  for (const MeasuredPart* part : near) {
    if (!request.hasNearParts) break;
    const Aabb reach = grown(boxIn(*part, subject), map.range);
    add(*part, std::make_shared<const SampledSurface>(
                   sampleSurface(part->geometry->mesh, {spacing, each, reach}, sampling)));
  }

  const auto placedTarget = [this](const MeasuredPart& target, const MeasuredPart& part) {
    return PlacedTarget<Target>{target.id, targetOf(target.geometry), relativePose(target, part),
                                target.worldFromPart};
  };
  const ProgressCallback measuring = stageCallback(progress, kSampled, 1.0);
  SharedProgress done(measuring, std::max<double>(1.0, static_cast<double>(map.samples())));
  for (std::size_t i = 0; i < map.surfaces.size(); ++i) {
    const bool isSubject = i < map.subjectCount;
    const MeasuredPart& part = isSubject ? *subject[i] : *near[i - map.subjectCount];
    std::vector<PlacedTarget<Target>> others;
    for (const MeasuredPart* other : isSubject ? near : subject)
      others.push_back(placedTarget(*other, part));
    measure<Target>(map.surfaces[i], others, map.range, request.isParallel, done);
  }
  if (isAutomatic) narrow(map, narrowedRange(map, sizeOf(subject), request.keptRange));
  const auto isBeyond = [](const MappedSurface& mapped) {
    return std::ranges::all_of(mapped.distances, [](double distance) { return std::isnan(distance); });
  };
  const auto firstNear = map.surfaces.begin() + static_cast<std::ptrdiff_t>(map.subjectCount);
  map.surfaces.erase(std::remove_if(firstNear, map.surfaces.end(), isBeyond), map.surfaces.end());
  return map;
}

std::shared_ptr<const ClearanceMapper::Target> ClearanceMapper::targetOf(const PartGeometryPtr& geometry) {
  const std::lock_guard lock(mutex_);
  std::erase_if(targets_, [](const auto& entry) { return entry.second.geometry.expired(); });
  Kept& kept = targets_[geometry.get()];
  if (kept.target == nullptr) kept = {geometry, std::make_shared<const Target>(geometry)};
  return kept.target;
}

std::shared_ptr<const SampledSurface> ClearanceMapper::subjectSurface(const PartGeometryPtr& geometry,
                                                                      double spacing, std::size_t maxSamples,
                                                                      const ProgressCallback& progress) {
  {
    const std::lock_guard lock(mutex_);
    const auto at = sampled_.find(geometry.get());
    const bool isSame = at != sampled_.end() && at->second.geometry.lock() == geometry &&
                        at->second.spacing == spacing && at->second.maxSamples == maxSamples;
    if (isSame) return at->second.surface;
  }
  auto surface = std::make_shared<const SampledSurface>(
      sampleSurface(geometry->mesh, {spacing, maxSamples, std::nullopt}, progress));
  const std::lock_guard lock(mutex_);
  sampled_[geometry.get()] = {geometry, spacing, maxSamples, surface};
  return surface;
}

void ClearanceMapper::keepSamples(std::span<const MeasuredPart* const> subject) {
  const std::lock_guard lock(mutex_);
  std::erase_if(sampled_, [&](const auto& entry) {
    return std::ranges::none_of(
        subject, [&](const MeasuredPart* part) { return part->geometry.get() == entry.first; });
  });
}

double sampleSpacing(double range, double size) noexcept {
  constexpr double kOfRange = 1.0 / 8.0, kMinOfSize = 1.0 / 200.0, kMaxOfSize = 1.0 / 20.0;
  const double spacing = std::clamp(kOfRange * range, kMinOfSize * size, kMaxOfSize * size);
  return std::max(spacing, std::numeric_limits<double>::min());
}

double automaticRange(double size, double leastDistance, double kept) noexcept {
  return keptOrRounded(searchedRange(size, leastDistance), kept);
}

std::optional<double> clearanceAt(const MappedSurface& mapped, std::uint32_t triangle,
                                  const glm::dvec3& point) {
  const SampledSurface& surface = *mapped.surface;
  if (triangle + 1 >= surface.firstOf.size()) return std::nullopt;
  double best = -kInfinity;
  std::optional<double> clearance;
  for (std::uint32_t i = surface.firstOf[triangle]; i < surface.firstOf[triangle + 1]; ++i) {
    const Triangle& t = surface.triangles[i];
    const glm::dvec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
    const glm::dvec3 across = glm::cross(b - a, c - a);
    const double square = glm::dot(across, across);
    if (!(square > 0.0)) continue;
    const double v = glm::dot(glm::cross(point - a, c - a), across) / square;
    const double w = glm::dot(glm::cross(b - a, point - a), across) / square;
    const double u = 1.0 - v - w, inside = std::min({u, v, w});
    // The one that holds the point, or misses it least by rounding.
    if (!(inside > best)) continue;
    best = inside;
    const double value = u * mapped.distances[t[0]] + v * mapped.distances[t[1]] + w * mapped.distances[t[2]];
    clearance = std::isnan(value) ? std::nullopt : std::optional(value);
  }
  return clearance;
}

}  // namespace nearfit
