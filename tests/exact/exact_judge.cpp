#include "tests/exact/exact_judge.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/math/aabb.h"

namespace nearfit::test {
namespace {

/// Agreement asked of points and distances, as a fraction of the scene's size, and of far coordinates.
constexpr double kAgreement = 1e-11;
constexpr double kCoordinates = 4e-16;

/// What is parallel to this may be reported as one flat region [rad], whose directions differ by less than
/// the second; and by how much those of near-parallel edges that are none may.
constexpr double kFlatRegion = 2e-6, kRegionWay = 2e-3, kContactWay = 1e-4;

/// No two are as close as this at both ends and in direction; on either side of a thin sheet there are.
constexpr double kSamePlace = 4e-12, kSameWay = 1.0 - 1e-6;

/// Nearer than this fraction of the size bodies touch, as far as double precision can tell: no promise is
/// made.
constexpr double kTouching = 1e-13;

/// Found ones may miss a condition by this many times what is promised to be resolved.
constexpr double kMinMargin = -2.0;

/// Exact ones that meet all conditions by as much are found at their own place, once: nearer to the end of a
/// feature they may have become one with what its neighbour says.
constexpr double kCertain = 10.0;

/// Of the promised resolution: rounding bounds, which count every operation, are some times what is promised
/// of directions between points.
constexpr double kCloseCall = 40.0;

std::string describe(const ExactMinimum& e) {
  return fmt::format("exact {}-{} at {:.17g}, margin {:.3g}, {:.17g} {:.17g} {:.17g}", e.features[0],
                     e.features[1], e.distance, e.margin, e.scenePoint.x, e.scenePoint.y, e.scenePoint.z);
}

double centreOf(const TriangleMesh& mesh) {
  Aabb box;
  for (const glm::dvec3& x : mesh.vertices())
    box.add(x);
  return glm::length(0.5 * (box.lower + box.upper));
}

}  // namespace

std::string describe(const Lmd& f) {
  return fmt::format("found {}-{} of {} and {} at {:.17g}{}{}, {:.17g} {:.17g} {:.17g}",
                     "vef"[static_cast<int>(f.sceneFeature)], "vef"[static_cast<int>(f.partFeature)],
                     f.sceneIndex, f.partIndex, f.distance, f.isRegion ? ", region" : "",
                     f.isMarginal ? ", marginal" : "", f.scenePoint.x, f.scenePoint.y, f.scenePoint.z);
}

std::string describe(const RigidTransform& pose) {
  const glm::dquat& q = pose.rotation;
  return fmt::format("pose {:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}", pose.translation.x,
                     pose.translation.y, pose.translation.z, q.w, q.x, q.y, q.z);
}

ExactJudge::ExactJudge(const BodyPair& pair)
    : oracle_(pair.scene, pair.part), centres_(centreOf(pair.scene) + centreOf(pair.part)) {}

std::vector<ExactMinimum> ExactJudge::minimaAt(const RigidTransform& pose, double cutoff) const {
  // What is flat is told at the features' middles: elsewhere a tilted region is nearer.
  return oracle_.minima(pose, cutoff + kFlatRegion * size(), kMinMargin);
}

double ExactJudge::pointTolerance(const Lmd& f) const {
  return kAgreement * size() + kCoordinates * (glm::length(f.scenePoint) + centres_);
}

/// At one place.
bool ExactJudge::isAt(const Lmd& f, const ExactMinimum& e) const {
  const double tolerance = pointTolerance(f) + e.place;
  return std::abs(f.distance - e.distance) <= kAgreement * size() &&
         glm::distance(f.scenePoint, e.scenePoint) <= tolerance &&
         glm::distance(f.partPoint, e.partPoint) <= tolerance;
}

/// A place of a region, or at its rim, of either body: from one corner two ways may lead that differ.
bool ExactJudge::isWithin(const Lmd& f, const ExactMinimum& e) const {
  const double apart =
      std::min(glm::distance(f.scenePoint, e.scenePoint), glm::distance(f.partPoint, e.partPoint));
  return apart <= 2.0 * f.extent.halfLength + kFlatRegion * size();
}

/// At one distance and in one direction: what places in a flat region share.
bool ExactJudge::isSameContact(const Lmd& f, const ExactMinimum& e) const {
  const bool isFlat = f.isRegion || e.isFlat;
  return std::abs(f.distance - e.distance) <= (isFlat ? kFlatRegion : kAgreement) * size() &&
         glm::distance(f.direction, e.direction) <=
             (isFlat ? kRegionWay : kContactWay) + kAgreement * size() / e.distance;
}

/// Though elsewhere.
bool ExactJudge::standsFor(const Lmd& f, const ExactMinimum& e, bool isCertain) const {
  if (!isSameContact(f, e)) return false;
  if (f.isRegion) return !isCertain || std::min(e.angle, e.tilt) < kFlatRegion || isWithin(f, e);
  // Within ten times the resolution two may become one.
  const double merged = kCertain * (kAgreement * size() + 1e-10 * e.distance);
  return !isCertain && (f.isMarginal || glm::distance(f.scenePoint, e.scenePoint) <= merged);
}

bool ExactJudge::isMissing(const ExactMinimum& e, const std::vector<Lmd>& found, bool isCertain) const {
  return e.isPromised && std::none_of(found.begin(), found.end(),
                                      [&](auto& f) { return isAt(f, e) || standsFor(f, e, isCertain); });
}

bool ExactJudge::isRightlyMarginal(const Lmd& f, const std::vector<const ExactMinimum*>& at,
                                   double cutoff) const {
  return std::any_of(at.begin(), at.end(), [&](const ExactMinimum* e) {
    return e->margin <= kCloseCall || e->distance > cutoff - kAgreement * size() ||
           e->distance < kAgreement * size() || f.isRegion;
  });
}

std::string ExactJudge::faultOf(const Lmd& f, const std::vector<ExactMinimum>& exact, double cutoff) const {
  if (f.distance < kTouching * size()) return "";
  std::vector<const ExactMinimum*> at;
  for (const ExactMinimum& e : exact) {
    if ((!e.isFlat && isAt(f, e)) || (f.isRegion && isSameContact(f, e))) at.push_back(&e);
  }
  if (at.empty()) return "spurious " + describe(f);
  const bool isSure = std::any_of(at.begin(), at.end(), [&](const ExactMinimum* e) {
    return f.isRegion || (e->margin >= 0.0 && e->distance <= cutoff);
  });
  if (!isSure && !f.isMarginal) return "not said to be marginal " + describe(f) + ", " + describe(*at[0]);
  if (f.isMarginal && !isRightlyMarginal(f, at, cutoff))
    return "marginal without need " + describe(f) + ", " + describe(*at[0]);
  if (glm::distance(f.partPoint - f.scenePoint, f.distance * f.direction) >
      pointTolerance(f) + (f.isRegion ? kFlatRegion * size() : 0.0))
    return "points, distance and direction disagree: " + describe(f);
  return "";
}

std::vector<std::string> ExactJudge::faults(const std::vector<Lmd>& found,
                                            const std::vector<ExactMinimum>& exact, double cutoff,
                                            ExactTally& tally) const {
  std::vector<std::string> faults;
  for (const ExactMinimum& e : exact) {
    if (e.isFlat || e.margin < 0.0 || e.distance > cutoff || e.distance < kAgreement * size()) continue;
    const bool isCertain = e.margin > kCertain;
    (isCertain ? tally.minima : tally.marginal) += 1;
    if (isCertain && std::count_if(found.begin(), found.end(), [&](auto& f) { return isAt(f, e); }) > 1)
      faults.push_back("more than one at " + describe(e));
    if (isMissing(e, found, isCertain)) faults.push_back("missing " + describe(e));
  }
  for (const Lmd& f : found) {
    if (const std::string fault = faultOf(f, exact, cutoff); !fault.empty()) faults.push_back(fault);
    const auto places = std::count_if(found.begin(), found.end(), [&](auto& g) {
      return glm::distance(f.scenePoint, g.scenePoint) <= kSamePlace * size() &&
             glm::distance(f.partPoint, g.partPoint) <= kSamePlace * size() &&
             glm::dot(f.direction, g.direction) > kSameWay;
    });
    if (places != 1 && f.distance >= kTouching * size()) faults.push_back("found twice: " + describe(f));
    tally.flagged += f.isMarginal ? 1 : 0;
  }
  tally.found += found.size();
  return faults;
}

}  // namespace nearfit::test
