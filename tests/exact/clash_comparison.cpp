#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/parallel/parallel_for.h"
#include "core/scene/part_geometry.h"
#include "tests/exact/exact_verdicts.h"
#include "tests/exact/shared_volume.h"

namespace nearfit::test {
namespace {

/// Error of coordinates of double precision, as a share of the bodies' size.
constexpr double kPlaceRounding = 1e-11;
/// Share of the smaller body's box: smaller volumes are compared with it.
constexpr double kSmallVolume = 1e-4;

/// Two parts that clash, in the frame of the second.
struct ClashPair {
  const PairFinding* finding;
  const CheckedPart *part, *other;
  RigidTransform otherFromPart;

  std::string names() const { return fmt::format("\"{}\" and \"{}\"", part->ruled.name, other->ruled.name); }
  RigidTransform movedBy(double length) const {
    RigidTransform moved = otherFromPart;
    const glm::dvec3 world = finding->clash->freeing->direction;
    moved.translation += length * (glm::inverse(other->worldFromPart.rotation) * world);
    return moved;
  }
  double rounding() const {
    return kPlaceRounding *
           (part->geometry->mesh.bounds().diagonal() + other->geometry->mesh.bounds().diagonal() +
            glm::length(otherFromPart.translation));
  }
};

std::vector<ClashPair> clashPairs(const SceneCheckRequest& request, const SceneCheck& check) {
  const auto partOf = [&](PartId id) { return &*std::ranges::find(request.parts, id, &CheckedPart::id); };
  std::vector<ClashPair> pairs;
  for (const PairFinding& finding : check.findings) {
    if (!finding.clash) continue;
    const CheckedPart *part = partOf(finding.pair.part), *other = partOf(finding.pair.other);
    pairs.push_back(
        {&finding, part, other, (other->worldFromPart.inverse() * part->worldFromPart).normalized()});
  }
  return pairs;
}

void compareDepth(const ClashPair& pair, ClashComparison& out) {
  const ClashMeasures& clash = *pair.finding->clash;
  if (!clash.freeing) return;
  const ExactBodies bodies(pair.other->geometry->tree().mesh(), pair.part->geometry->tree().mesh());
  const double length = clash.freeing->length;
  const double slack = kDepthTolerance * length + pair.rounding();
  ++out.depths;
  if (bodies.isFree(pair.movedBy(length + pair.rounding()))) {
    ++out.freed;
  } else {
    out.differences.push_back(
        fmt::format("{} are not freed by their depth of {:.17g} m", pair.names(), length));
  }
  if (length <= slack || !bodies.isFree(pair.movedBy(length - slack))) {
    ++out.least;
  } else {
    out.differences.push_back(
        fmt::format("{} are freed by less than their depth of {:.17g} m", pair.names(), length));
  }
  const bool isBeaten = length > slack && bodies.isFreedBy(length - slack, pair.otherFromPart);
  out.beaten += isBeaten ? 1 : 0;
  if (!clash.isDepthExact) return;
  ++out.exactDepths;
  if (isBeaten) {
    out.differences.push_back(
        fmt::format("{} are freed by less than {:.17g} m another way", pair.names(), length));
  } else {
    ++out.exactLeast;
  }
}

double relativeDifference(const ClashPair& pair, double volume, double expected) {
  const auto boxVolume = [](const CheckedPart& part) {
    const Aabb& box = part.geometry->mesh.bounds();
    const glm::dvec3 size = box.upper - box.lower;
    return size.x * size.y * size.z;
  };
  const double small = kSmallVolume * std::min(boxVolume(*pair.part), boxVolume(*pair.other));
  return std::abs(volume - expected) / std::max(expected, small);
}

void compareRays(const ClashPair& pair, std::size_t cells, ClashComparison& out) {
  const double said = *pair.finding->clash->volume;
  const double rays =
      sharedVolumeByRays(pair.other->geometry->mesh, pair.part->geometry->mesh, pair.otherFromPart, cells);
  const double difference = relativeDifference(pair, said, rays);
  out.worstRays = std::max(out.worstRays, difference);
  if (difference <= kRayTolerance) {
    ++out.raysAgree;
  } else {
    out.differences.push_back(
        fmt::format("{} share {:.9g} m^3 by the check, {:.9g} m^3 by rays", pair.names(), said, rays));
  }
}

void compareBoolean(const ClashPair& pair, ClashComparison& out) {
  const std::optional<double> nef =
      sharedVolumeByNef(pair.other->geometry->mesh, pair.part->geometry->mesh, pair.otherFromPart);
  if (!nef) return;
  const double said = *pair.finding->clash->volume, difference = relativeDifference(pair, said, *nef);
  ++out.booleans;
  out.worstBoolean = std::max(out.worstBoolean, difference);
  if (difference <= kBooleanTolerance) {
    ++out.booleansAgree;
  } else {
    out.differences.push_back(fmt::format("{} share {:.12g} m^3 by the check, {:.12g} m^3 by Nef polyhedra",
                                          pair.names(), said, *nef));
  }
}

}  // namespace

void ClashComparison::add(const ClashComparison& other) {
  clashes += other.clashes;
  depths += other.depths;
  freed += other.freed;
  least += other.least;
  beaten += other.beaten;
  exactDepths += other.exactDepths;
  exactLeast += other.exactLeast;
  volumes += other.volumes;
  raysAgree += other.raysAgree;
  booleans += other.booleans;
  booleansAgree += other.booleansAgree;
  worstRays = std::max(worstRays, other.worstRays);
  worstBoolean = std::max(worstBoolean, other.worstBoolean);
  differences.insert(differences.end(), other.differences.begin(), other.differences.end());
}

ClashComparison compareClashes(const SceneCheckRequest& request, const SceneCheck& check,
                               const ClashComparisonOptions& options) {
  const std::vector<ClashPair> pairs = clashPairs(request, check);
  std::vector<ClashComparison> each(pairs.size());
  parallelFor(pairs.size(), [&](std::size_t i) {
    each[i].clashes = 1;
    compareDepth(pairs[i], each[i]);
    if (!pairs[i].finding->clash->volume) return;
    each[i].volumes = 1;
    compareRays(pairs[i], options.cells, each[i]);
  });
  ClashComparison all;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::size_t triangles =
        pairs[i].part->geometry->mesh.triangles().size() + pairs[i].other->geometry->mesh.triangles().size();
    if (each[i].volumes > 0 && triangles <= options.maxBooleanTriangles && all.booleans < options.maxBooleans)
      compareBoolean(pairs[i], each[i]);
    all.add(each[i]);
  }
  return all;
}

}  // namespace nearfit::test
