#include "core/verdict/pair_separation.h"

#include <algorithm>
#include <limits>

#include "core/proximity/overlap/containment.h"
#include "core/proximity/overlap/touching_bodies.h"
#include "core/proximity/query/broad_phase.h"
#include "core/proximity/surface/surface_distance.h"

namespace nearfit {
namespace {

constexpr std::uint64_t kAnyWork = std::numeric_limits<std::uint64_t>::max();

}  // namespace

double touchTolerance(const PartGeometry& a, const PartGeometry& b) noexcept {
  constexpr double kShare = 1e-6, kMax = 1e-6;
  const double size = std::min(a.mesh.bounds().diagonal(), b.mesh.bounds().diagonal());
  return std::clamp(kShare * size, std::numeric_limits<double>::min(), kMax);
}

std::optional<PairSeparation> separationOf(const PartGeometry& part, const PartGeometry& other,
                                           const RigidTransform& otherFromPart, double within,
                                           LmdScratch& scratch) {
  ComponentsOnDemand partPieces, otherPieces;
  return separationOf(part, other, otherFromPart, within, scratch, {partPieces, otherPieces});
}

std::optional<PairSeparation> separationOf(const PartGeometry& part, const PartGeometry& other,
                                           const RigidTransform& otherFromPart, double within,
                                           LmdScratch& scratch, const PairComponents& components) {
  const NormalConeTree &a = part.tree(), &b = other.tree();
  const auto nearestWithin = [&](double limit) {
    return leastSurfaceDistance(b, a, otherFromPart, limit, scratch, kAnyWork);
  };
  SurfaceDistance nearest = nearestWithin(within);
  const bool doBoxesMeet = doOverlap(boundsOf(a.mesh().bounds(), otherFromPart), b.mesh().bounds());
  if (!nearest.isFound && !doBoxesMeet) return std::nullopt;
  PairSeparation result;
  Interference found;
  if (doBoxesMeet) found = findInterference({b, components.other}, {a, components.part}, otherFromPart);
  result.overlap = found.kind;
  const bool doMeet = result.overlap != InterferenceKind::Disjoint;
  if (!nearest.isFound) {
    if (!doMeet) return std::nullopt;
    nearest = nearestWithin(std::numeric_limits<double>::infinity());
  }
  result.distance = doMeet ? 0.0 : nearest.distance;
  result.partPoint = nearest.partPoint;
  result.otherPoint = nearest.scenePoint;
  const double tolerance = touchTolerance(part, other);
  result.isTouching =
      doMeet ? doOnlyTouch(b, a, otherFromPart, tolerance, found) : result.distance <= tolerance;
  return result;
}

std::optional<double> distanceWithin(const PartGeometry& part, const PartGeometry& other,
                                     const RigidTransform& otherFromPart, double within, LmdScratch& scratch,
                                     const PairComponents& components) {
  const NormalConeTree &a = part.tree(), &b = other.tree();
  const bool doBoxesMeet = doOverlap(boundsOf(a.mesh().bounds(), otherFromPart), b.mesh().bounds());
  if (doBoxesMeet) {
    const Interference found = findInterference({b, components.other}, {a, components.part}, otherFromPart);
    if (found.kind != InterferenceKind::Disjoint) return 0.0;
  }
  const SurfaceDistance nearest = leastSurfaceDistance(b, a, otherFromPart, within, scratch, kAnyWork);
  return nearest.isFound ? std::optional(nearest.distance) : std::nullopt;
}

PairVerdict verdictOf(const PairSeparation& separation) noexcept {
  if (separation.isTouching) return PairVerdict::Touching;
  switch (separation.overlap) {
    case InterferenceKind::Disjoint:
      return PairVerdict::Near;
    case InterferenceKind::SurfacesMeet:
      return PairVerdict::Clash;
    default:
      return PairVerdict::Contained;
  }
}

}  // namespace nearfit
