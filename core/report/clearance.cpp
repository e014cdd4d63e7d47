#include "core/report/clearance.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <span>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/proximity/tracking/lmd_set.h"
#include "core/report/csv_text.h"
#include "core/verdict/pair_separation.h"

namespace nearfit {
namespace {

/// Max minima counted per pair; for more, a table only needs "more than".
constexpr std::size_t kMaxMinima = 10'000;

struct Workspace {
  LmdCollector collector{kMaxMinima};
  LmdScratch scratch;
};

PartClearance clearanceOf(const Part& part, const Part& other, double cutoff, Workspace& work) {
  const PartGeometry &a = *part.geometry, &b = *other.geometry;
  const RigidTransform otherFromPart = (other.worldFromPart.inverse() * part.worldFromPart).normalized();
  PartClearance result;
  result.part = part.id;
  result.other = other.id;
  result.isBetweenSolids = a.isSolid() && b.isSolid();
  const std::optional<PairSeparation> found =
      separationOf(a, b, otherFromPart, std::numeric_limits<double>::infinity(), work.scratch);
  if (!found) {
    // Neither has a triangle that could be near: all are too thin.
    result.distance = std::numeric_limits<double>::infinity();
    return result;
  }
  result.overlap = found->overlap;
  result.isTouching = found->isTouching;
  result.distance = found->distance;
  result.partPoint = other.worldFromPart.applyToPoint(found->partPoint);
  result.otherPoint = other.worldFromPart.applyToPoint(found->otherPoint);
  if (result.overlap != InterferenceKind::Disjoint) return result;
  const LmdSet minima = work.collector.collect(b.tree(), a.tree(), otherFromPart, cutoff);
  result.minima = minima.lmds.size();
  result.isEveryMinimum = minima.isComplete;
  return result;
}

/// Puts a further part of a body into its clearance to another one.
void include(const PartClearance& added, PartClearance& all) {
  const auto rank = [](const PartClearance& c) { return c.isOverlapping() ? 0 : c.isTouching ? 1 : 2; };
  const bool isNearer = rank(added) != rank(all) ? rank(added) < rank(all) : added.distance < all.distance;
  const PartClearance before = all;
  if (isNearer) all = added;
  all.minima = before.minima + added.minima;
  all.isEveryMinimum = before.isEveryMinimum && added.isEveryMinimum;
  all.isDistanceBound = before.isDistanceBound || added.isDistanceBound;
  all.isBetweenSolids = before.isBetweenSolids && added.isBetweenSolids;
}

/// The parts whose surfaces count: of one that is asked for alone, hidden or not.
std::vector<const Part*> surfacesOf(const Scene& scene, const std::vector<PartId>& body) {
  std::vector<const Part*> parts;
  for (const PartId id : body) {
    const Part* part = scene.find(id);
    if (part == nullptr) throw UsageError("clearance", "there is no such part", "choose a part of the scene");
    if (hasTriangles(*part) && (part->isVisible || body.size() == 1)) parts.push_back(part);
  }
  return parts;
}

}  // namespace

std::vector<PartClearance> clearancesOf(const Scene& scene, PartId id, double cutoff,
                                        const ProgressCallback& progress) {
  return clearancesOf(scene, std::vector{id}, cutoff, progress);
}

std::vector<PartClearance> clearancesOf(const Scene& scene, const std::vector<PartId>& body, double cutoff,
                                        const ProgressCallback& progress) {
  const std::vector<const Part*> parts = surfacesOf(scene, body);
  if (!(cutoff > 0.0) || !std::isfinite(cutoff))
    throw UsageError("clearance", fmt::format("{} m is not a valid cutoff", cutoff),
                     "give a length greater than 0");
  std::vector<PartClearance> result;
  if (parts.empty()) return result;
  const std::set<PartId> own(body.begin(), body.end());
  Workspace work;
  double done = 0.0;
  const double all = static_cast<double>(scene.parts().size()) * static_cast<double>(parts.size());
  for (const Scene::PartPtr& other : scene.parts()) {
    const bool isAsked = !own.contains(other->id) && other->isVisible && hasTriangles(*other);
    std::optional<PartClearance> sum;
    for (const Part* part : parts) {
      if (progress && !progress(done++ / all)) throw Cancelled();
      if (!isAsked) continue;
      const PartClearance one = clearanceOf(*part, *other, cutoff, work);
      sum ? include(one, *sum) : void(sum = one);
    }
    if (sum) result.push_back(*sum);
  }
  return result;
}

void updateFrom(const ServoSnapshot& snapshot, std::vector<PartClearance>& clearances) noexcept {
  // Surfaces that pass through each other have minima too: only where it is known what overlaps do they tell a distance.
  if (snapshot.isOverlapUnknown || snapshot.overlappingCount > ServoSnapshot::kMaxOverlapping) return;
  const bool isEvery = !snapshot.isTruncated && snapshot.storedLmds == snapshot.lmdCount;
  const auto overlapping = std::span(snapshot.overlapping).first(snapshot.overlappingCount);
  for (PartClearance& each : clearances) {
    if (!each.isBetweenSolids || std::ranges::find(overlapping, each.other) != overlapping.end()) continue;
    const SnapshotLmd* nearest = nullptr;
    std::size_t count = 0;
    for (const SnapshotLmd& minimum : std::span(snapshot.lmds).first(snapshot.storedLmds)) {
      if (minimum.other != each.other) continue;
      ++count;
      if (nearest == nullptr || minimum.lmd.distance < nearest->lmd.distance) nearest = &minimum;
    }
    if (nearest == nullptr) continue;
    const Lmd& lmd = nearest->lmd;
    each.isDistanceBound = snapshot.isDistanceBound && snapshot.distance < lmd.distance;
    each.distance = each.isDistanceBound ? snapshot.distance : lmd.distance;
    each.part = nearest->part;
    each.partPoint = lmd.partPoint;
    each.otherPoint = lmd.scenePoint;
    each.minima = count;
    each.isEveryMinimum = isEvery;
    each.overlap = InterferenceKind::Disjoint;
    each.isTouching = false;
  }
}

const char* nameOf(InterferenceKind overlap) noexcept {
  switch (overlap) {
    case InterferenceKind::Disjoint:
      return "no";
    case InterferenceKind::SurfacesMeet:
      return "surfaces meet";
    case InterferenceKind::PartInside:
      return "inside the other";
    case InterferenceKind::SceneInside:
      break;
  }
  return "the other inside";
}

std::string clearanceCsv(const Scene& scene, const std::vector<PartClearance>& clearances) {
  const auto nameOfPart = [&](PartId which) {
    const Part* part = scene.find(which);
    return part != nullptr ? csvField(part->name) : std::string();
  };
  std::string text = "part,other";
  for (const char* name : {"distance", "part_x", "part_y", "part_z", "other_x", "other_y", "other_z"})
    fmt::format_to(std::back_inserter(text), ",{} [m]", name);
  text += ",minima,every_minimum,overlap,distance_bound\n";
  for (const PartClearance& c : clearances) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{:d},{},{:d}\n",
                   nameOfPart(c.part), nameOfPart(c.other), c.distance, c.partPoint.x, c.partPoint.y,
                   c.partPoint.z, c.otherPoint.x, c.otherPoint.y, c.otherPoint.z, c.minima, c.isEveryMinimum,
                   c.isTouching ? "touching" : nameOf(c.overlap), c.isDistanceBound);
  }
  return text;
}

}  // namespace nearfit
