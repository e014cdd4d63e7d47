#include "core/batch/part_queries.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/math/finite.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/proximity/overlap/interference.h"
#include "core/verdict/pair_separation.h"

namespace nearfit {
namespace {

/// Poses that a thread takes at a time: enough that taking them costs nothing, few enough that all end together.
constexpr std::size_t kStretch = 16;
/// Poses that are followed in a row. Fixed, so that results do not depend on the number of threads; a list serves
/// some tens of poses.
constexpr std::size_t kTrackedStretch = 256;
/// Triangles of all parts from which a pose may take long: some ten milliseconds where their surfaces face each other all
/// over, next to which a report of progress is nothing.
constexpr std::size_t kSlowTriangles = 20'000;
/// Share of all lengths involved that rounding may take from the distance of two spheres; thousands of roundings.
constexpr double kSphereRounding = 1e-12;

void requireLength(const char* what, double value, bool mayBeInfinite) {
  if (value > 0.0 && (mayBeInfinite || std::isfinite(value))) return;
  throw UsageError(what, fmt::format("{} is out of range", value),
                   mayBeInfinite ? "give a number above zero" : "give a finite number above zero");
}

void requireSprings(const SpringParameters& springs) {
  requireLength("cutoff", springs.cutoff, false);
  if (std::isfinite(springs.stiffness) && springs.stiffness >= 0.0) return;
  throw UsageError("stiffness", fmt::format("{} is out of range", springs.stiffness),
                   "give a finite number that is not negative");
}

bool isIdentity(const RigidTransform& pose) noexcept {
  return pose == RigidTransform{};
}

}  // namespace

PartQueries::PartQueries(const Scene& scene, PartId part, const ProgressCallback& progress)
    : part_(scene.get(part).geometry), spaces_([] { return std::make_unique<Space>(); }) {
  if (!hasTriangles(scene.get(part)))
    throw UsageError(scene.get(part).name, "it has no triangles", "give it a mesh");
  std::vector<PartGeometryPtr> geometries{part_};
  std::vector<std::string> names;
  std::map<const PartGeometry*, std::shared_ptr<ComponentsOnDemand>> components;
  const auto componentsOf = [&components](const PartGeometry* geometry) {
    std::shared_ptr<ComponentsOnDemand>& shared = components[geometry];
    if (!shared) shared = std::make_shared<ComponentsOnDemand>();
    return shared;
  };
  partComponents_ = componentsOf(part_.get());
  for (const Scene::PartPtr& other : scene.parts()) {
    if (other->id == part || !other->isVisible || !hasTriangles(*other)) continue;
    std::shared_ptr<ComponentsOnDemand> shared = componentsOf(other->geometry.get());
    others_.push_back({.geometry = other->geometry,
                       .components = std::move(shared),
                       .worldFromOther = other->worldFromPart,
                       .isAtOrigin = isIdentity(other->worldFromPart),
                       .centre = {},
                       .radius = 0.0});
    names.push_back(other->name);
    geometries.push_back(other->geometry);
  }
  names_ = std::make_shared<const std::vector<std::string>>(std::move(names));
  std::size_t triangles = 0;
  for (const PartGeometryPtr& geometry : geometries)
    triangles += geometry->mesh.triangles().size();
  arePosesSlow_ = triangles >= kSlowTriangles;
  prepareHierarchies(geometries, progress);
  constexpr double kHalf = 0.5;
  partCentre_ = part_->tree().centre();
  partRadius_ = kHalf * part_->tree().size();
  for (Other& other : others_) {
    other.centre = other.worldFromOther.applyToPoint(other.geometry->tree().centre());
    other.radius = kHalf * other.geometry->tree().size();
  }
}

RigidTransform PartQueries::poseIn(const Other& other, const RigidTransform& worldFromPart) const noexcept {
  // Dividing a unit quaternion by its length may change its last bit.
  if (other.isAtOrigin) return worldFromPart;
  return (other.worldFromOther.inverse() * worldFromPart).normalized();
}

bool PartQueries::isFarther(const Other& other, const RigidTransform& worldFromPart,
                            double distance) const noexcept {
  const glm::dvec3 centre = worldFromPart.applyToPoint(partCentre_);
  const double reach = distance + partRadius_ + other.radius;
  const double lengths = reach + glm::length(centre) + glm::length(other.centre) + glm::length(partCentre_) +
                         glm::length(worldFromPart.translation);
  return glm::distance(centre, other.centre) > reach + kSphereRounding * lengths;
}

LmdSet PartQueries::setOf(std::size_t other, const RigidTransform& otherFromPart, double cutoff, Space& space,
                          FollowedPairs* followed) const {
  const NormalConeTree &scene = others_[other].geometry->tree(), &part = part_->tree();
  if (followed == nullptr) return space.collector.collect(scene, part, otherFromPart, cutoff);
  std::optional<FollowedPair>& pair = (*followed)[other];
  if (!pair) pair.emplace(scene, part);
  return space.collector.collectTracked(*pair, otherFromPart, cutoff);
}

bool PartQueries::findAt(const RigidTransform& pose, const SpringParameters& springs, Space& space,
                         FollowedPairs* followed) const {
  space.found.clear();
  bool isWhole = true;
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const Other& other = others_[i];
    if (isFarther(other, pose, springs.cutoff)) continue;
    const RigidTransform otherFromPart = poseIn(other, pose);
    LmdSet set = setOf(i, otherFromPart, springs.cutoff, space, followed);
    if (springs.onePerArea) {
      space.collector.mergeByArea(other.geometry->tree(), part_->tree(), otherFromPart, springs.cutoff, set);
    }
    isWhole = isWhole && set.isComplete;
    for (const Lmd& lmd : set.lmds) {
      space.found.push_back({.lmd = other.isAtOrigin ? lmd : transformed(lmd, other.worldFromOther),
                             .other = static_cast<std::int32_t>(i)});
    }
  }
  return isWhole;
}

double PartQueries::distanceAt(const RigidTransform& pose, double within, Space& space) const {
  if (!space.scratch) space.scratch.emplace();
  double least = std::numeric_limits<double>::infinity();
  for (const Other& other : others_) {
    // Zero is the least that there is, and no limit of a search.
    if (least == 0.0) break;
    const double limit = std::min(within, least);
    if (isFarther(other, pose, limit)) continue;
    const std::optional<double> distance =
        distanceWithin(*part_, *other.geometry, poseIn(other, pose), limit, *space.scratch,
                       {.part = *partComponents_, .other = *other.components});
    if (distance) least = std::min(least, *distance);
  }
  return least;
}

bool PartQueries::overlapsAt(const RigidTransform& pose) const {
  return std::ranges::any_of(others_, [&](const Other& other) {
    if (isFarther(other, pose, 0.0)) return false;
    const InterferenceBody scene{.tree = other.geometry->tree(), .components = *other.components};
    const InterferenceBody part{.tree = part_->tree(), .components = *partComponents_};
    return findInterference(scene, part, poseIn(other, pose)).kind != InterferenceKind::Disjoint;
  });
}

Wrench PartQueries::wrenchOf(std::size_t index, const RigidTransform& pose, const SpringParameters& springs,
                             bool isWhole, Space& space) const {
  const std::string where = fmt::format("pose {}", index);
  if (!isWhole) {
    throw Error(where, fmt::format("there are more than {} minima within the cutoff", kMaxBatchMinima),
                "give a smaller cutoff");
  }
  space.lmds.clear();
  for (const FoundLmd& found : space.found)
    space.lmds.push_back(found.lmd);
  const Wrench wrench = springWrench(space.lmds, springs, pose.applyToPoint(part_->mass.centre), {});
  if (!isFinite(wrench.force) || !isFinite(wrench.torque))
    throw Error(where, "the force is too large for a number", "give a smaller stiffness");
  return wrench;
}

template <class Work>
void PartQueries::forStretches(std::size_t count, const BatchOptions& options, const Work& work) {
  const std::size_t length = options.isTracked ? kTrackedStretch : kStretch;
  const std::size_t stretches = (count + length - 1) / length;
  SharedProgress progress(options.progress, std::max(1.0, static_cast<double>(count)));
  std::atomic<std::size_t> next{0};
  const auto run = [&](std::size_t) {
    spaces_.with([&](Space& space) {
      for (std::size_t i = next++; i < stretches; i = next++) {
        FollowedPairs followed(options.isTracked ? others_.size() : 0);
        const std::size_t last = std::min(count, (i + 1) * length), step = arePosesSlow_ ? 1 : length;
        for (std::size_t begin = i * length; begin < last; begin += step) {
          const std::size_t end = std::min(last, begin + step);
          work(begin, end, space, options.isTracked ? &followed : nullptr);
          progress.add(static_cast<double>(end - begin));
        }
      }
    });
  };
  const std::size_t threads = options.threads == 0 ? stretches : std::min(options.threads, stretches);
  if (threads <= 1)
    run(0);
  else
    parallelFor(threads, run);
}

MinimaTable PartQueries::minima(std::span<const RigidTransform> poses, double cutoff,
                                const BatchOptions& options) {
  requireLength("cutoff", cutoff, false);
  SpringParameters springs;
  springs.cutoff = cutoff;
  const std::size_t length = options.isTracked ? kTrackedStretch : kStretch;
  std::vector<MinimaTable> tables((poses.size() + length - 1) / length);
  forStretches(poses.size(), options,
               [&](std::size_t begin, std::size_t end, Space& space, FollowedPairs* followed) {
                 MinimaTable& table = tables[begin / length];
                 for (std::size_t i = begin; i < end; ++i) {
                   const bool isWhole = findAt(poses[i], springs, space, followed);
                   // Minima of one part are sorted already; equal ones keep their order.
                   if (others_.size() > 1) {
                     std::ranges::stable_sort(space.found, {},
                                              [](const FoundLmd& found) { return found.lmd.distance; });
                   }
                   for (const FoundLmd& found : space.found)
                     table.add(found.lmd, found.other);
                   table.endPose(isWhole);
                 }
               });
  return joined(tables);
}

std::vector<double> PartQueries::distances(std::span<const RigidTransform> poses, double within,
                                           const BatchOptions& options) {
  requireLength("cutoff", within, true);
  std::vector<double> result(poses.size());
  forStretches(poses.size(), options, [&](std::size_t begin, std::size_t end, Space& space, FollowedPairs*) {
    for (std::size_t i = begin; i < end; ++i)
      result[i] = distanceAt(poses[i], within, space);
  });
  return result;
}

std::vector<std::uint8_t> PartQueries::overlaps(std::span<const RigidTransform> poses,
                                                const BatchOptions& options) {
  std::vector<std::uint8_t> result(poses.size());
  forStretches(poses.size(), options, [&](std::size_t begin, std::size_t end, Space&, FollowedPairs*) {
    for (std::size_t i = begin; i < end; ++i)
      result[i] = overlapsAt(poses[i]) ? 1 : 0;
  });
  return result;
}

std::vector<Wrench> PartQueries::wrenches(std::span<const RigidTransform> poses,
                                          const SpringParameters& springs, const BatchOptions& options) {
  requireSprings(springs);
  std::vector<Wrench> result(poses.size());
  forStretches(poses.size(), options,
               [&](std::size_t begin, std::size_t end, Space& space, FollowedPairs* followed) {
                 for (std::size_t i = begin; i < end; ++i) {
                   const bool isWhole = findAt(poses[i], springs, space, followed);
                   result[i] = wrenchOf(i, poses[i], springs, isWhole, space);
                 }
               });
  return result;
}

}  // namespace nearfit
