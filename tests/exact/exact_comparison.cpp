#include "tests/exact/exact_comparison.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/candidate_list.h"
#include "core/proximity/lmd_query.h"
#include "tests/exact/target_pose.h"

namespace nearfit::test {
namespace {

/// Agreement asked of points and distances, as a fraction of the scene's size, and of far coordinates.
constexpr double kAgreement = 1e-11;
constexpr double kCoordinates = 4e-16;

/// What is parallel to this may be reported as one flat region [rad], whose directions differ by less than
/// the second; and by how much those of near-parallel edges that are none may.
constexpr double kFlat = 2e-6, kRegionWay = 2e-3, kContactWay = 1e-4;

/// No two are as close as this at both ends and in direction; on either side of a thin sheet there are.
constexpr double kSamePlace = 4e-12, kSameWay = 1.0 - 1e-6;

/// Nearer than this fraction of the size bodies touch, as far as double precision can tell: no promise is
/// made.
constexpr double kTouching = 1e-13;

/// Found ones may miss a condition by this many times what is promised to be resolved.
constexpr double kLeastMargin = -2.0;

/// Exact ones that meet all conditions by as much are found at their own place, once: nearer to the end of a
/// feature they may have become one with what its neighbour says.
constexpr double kCertain = 10.0;

std::string describe(const Lmd& f) {
  return fmt::format("found {}-{} of {} and {} at {:.17g}, {:.17g} {:.17g} {:.17g}",
                     "vef"[static_cast<int>(f.sceneFeature)], "vef"[static_cast<int>(f.partFeature)],
                     f.sceneIndex, f.partIndex, f.distance, f.scenePoint.x, f.scenePoint.y, f.scenePoint.z);
}
std::string describe(const ExactMinimum& e) {
  return fmt::format("exact {}-{} at {:.17g}, margin {:.3g}, {:.17g} {:.17g} {:.17g}", e.features[0],
                     e.features[1], e.distance, e.margin, e.scenePoint.x, e.scenePoint.y, e.scenePoint.z);
}
std::string describe(const RigidTransform& pose) {
  const glm::dquat& q = pose.rotation;
  return fmt::format("pose {:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}", pose.translation.x,
                     pose.translation.y, pose.translation.z, q.w, q.x, q.y, q.z);
}

/// What a query with the bodies swapped says, told from the scene.
std::vector<Lmd> mirrored(std::vector<Lmd> swapped, const RigidTransform& pose) {
  const RigidTransform unit = pose.normalized();
  for (Lmd& f : swapped) {
    std::swap(f.scenePoint, f.partPoint);
    std::swap(f.sceneFeature, f.partFeature);
    std::swap(f.sceneIndex, f.partIndex);
    f.scenePoint = unit.applyToPoint(f.scenePoint);
    f.partPoint = unit.applyToPoint(f.partPoint);
    f.direction = unit.applyToVector(-f.direction);
  }
  return swapped;
}

}  // namespace

ExactComparison::ExactComparison(const BodyPair& pair)
    : pair_(pair), scene_(pair.scene), part_(pair.part), oracle_(pair.scene, pair.part) {}

double ExactComparison::pointTolerance(const Lmd& f) const {
  return kAgreement * size() + kCoordinates * (glm::length(f.scenePoint) + glm::length(scene_.centre()) +
                                               glm::length(part_.centre()));
}

/// At one place.
bool ExactComparison::isAt(const Lmd& f, const ExactMinimum& e) const {
  const double tolerance = pointTolerance(f) + e.place;
  return std::abs(f.distance - e.distance) <= kAgreement * size() &&
         glm::distance(f.scenePoint, e.scenePoint) <= tolerance &&
         glm::distance(f.partPoint, e.partPoint) <= tolerance;
}

/// A place of a region, or at its rim.
bool ExactComparison::isWithin(const Lmd& f, const ExactMinimum& e) const {
  return glm::distance(f.scenePoint, e.scenePoint) <= 2.0 * f.extent.halfLength + kFlat * size();
}

/// At one distance and in one direction: what places in a flat region share.
bool ExactComparison::isSameContact(const Lmd& f, const ExactMinimum& e) const {
  const bool isFlat = f.isRegion || e.isFlat;
  return std::abs(f.distance - e.distance) <= (isFlat ? kFlat : kAgreement) * size() &&
         glm::distance(f.direction, e.direction) <=
             (isFlat ? kRegionWay : kContactWay) + kAgreement * size() / e.distance;
}

void ExactComparison::checkSet(const std::vector<Lmd>& found, const std::vector<ExactMinimum>& exact,
                               double cutoff, const std::string& where) {
  for (const ExactMinimum& e : exact) {
    if (e.isFlat || e.margin < 0.0 || e.distance > cutoff - kAgreement * size() ||
        e.distance < kAgreement * size())
      continue;
    const bool isCertain = e.margin > kCertain;
    (isCertain ? tally_.minima : tally_.marginal) += 1;
    const auto places = std::count_if(found.begin(), found.end(), [&](auto& f) { return isAt(f, e); });
    EXPECT_LE(places, isCertain ? 1 : places) << where << ": " << describe(e);
    if (places > 0 || !e.isPromised) continue;
    const bool isCovered = std::any_of(found.begin(), found.end(), [&](auto& f) {
      return (!isCertain || (f.isRegion && (e.angle < kFlat || isWithin(f, e)))) && isSameContact(f, e);
    });
    EXPECT_TRUE(isCovered) << where << ": " << describe(e);
  }
  for (const Lmd& f : found) {
    if (f.distance < kTouching * size()) continue;
    const bool isExact = std::any_of(exact.begin(), exact.end(), [&](auto& e) {
      return (!e.isFlat && isAt(f, e)) || (f.isRegion && isSameContact(f, e));
    });
    EXPECT_TRUE(isExact) << where << ": spurious " << describe(f);
    EXPECT_LE(glm::distance(f.partPoint - f.scenePoint, f.distance * f.direction),
              pointTolerance(f) + (f.isRegion ? kFlat * size() : 0.0))
        << where;
    const auto places = std::count_if(found.begin(), found.end(), [&](auto& g) {
      return glm::distance(f.scenePoint, g.scenePoint) <= kSamePlace * size() &&
             glm::distance(f.partPoint, g.partPoint) <= kSamePlace * size() &&
             glm::dot(f.direction, g.direction) > kSameWay;
    });
    EXPECT_EQ(places, 1) << where << ": found twice: " << describe(f);
  }
  tally_.found += found.size();
}

void ExactComparison::checkVariants(const RigidTransform& pose, double cutoff,
                                    const std::vector<Lmd>& found) {
  const auto expectSame = [&](const LmdResult& result, const std::vector<Lmd>& other, const char* what) {
    ASSERT_EQ(result.count, found.size())
        << what << ", " << pair_.name << ", " << describe(pose) << ": "
        << (other.empty() ? std::string() : describe(other[result.count - 1]))
        << (found.empty() ? std::string() : " and " + describe(found.back()));
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(other[i].scenePoint, found[i].scenePoint) << what << ' ' << describe(pose);
      EXPECT_EQ(other[i].partPoint, found[i].partPoint) << what << ' ' << describe(pose);
    }
  };
  std::vector<Lmd> other(found.size() + 1);
  for (const SimdLevel level : availableSimdLevels()) {
    LmdScratch scratch(4096, level);
    expectSame(findLmds(scene_, part_, pose, cutoff, scratch, other), other, "instruction set");
  }
  LmdScratch scratch(4096);
  CandidateList list;
  RigidTransform start = pose;
  start.translation += glm::dvec3(0.3, -0.2, 0.1) * cutoff;
  list.build({scene_, part_, start, cutoff}, {{}, {0.5 * cutoff, 1e-3}}, scratch, {1U << 16, 1U << 22});
  if (!list.isUsable()) return;  // Thousands of features at one place; it says that it covers nothing.
  const std::optional<LmdResult> listed = list.query(pose, cutoff, scratch, other);
  ASSERT_TRUE(listed) << list.size() << " pairs, " << describe(pose);
  expectSame(*listed, other, "candidate list");
}

void ExactComparison::checkPose(const RigidTransform& pose, double cutoff) {
  ++tally_.poses;
  const double reach = cutoff + 2.0 * kAgreement * size();
  const std::vector<ExactMinimum> exact = oracle_.minima(pose, reach, kLeastMargin);
  const std::vector<Lmd> found = allLmds(scene_, part_, pose, cutoff);
  const std::string where = fmt::format("{}, {}, cutoff {:.17g}", pair_.name, describe(pose), cutoff);
  checkSet(found, exact, cutoff, where);
  // Far from the origin the inverse is another pose: its translation is rounded.
  if (glm::length(pose.translation) < 1e2 * size()) {
    const RigidTransform back = pose.normalized().inverse();
    checkSet(mirrored(allLmds(part_, scene_, back, cutoff), pose), exact, cutoff, where + ", swapped");
  }
  checkVariants(pose, cutoff, found);
}

void ExactComparison::checkPoses(std::size_t poses, double cutoffFraction, std::uint64_t seed) {
  const double cutoff = cutoffFraction * std::max(scene_.size(), part_.size());
  std::mt19937_64 random(seed);
  const auto failures = [] {
    return testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
  };
  const int before = failures();
  for (std::size_t i = 0; i < poses && failures() == before; ++i) {
    const std::size_t kind = i % 4;
    checkPose(kind == 0   ? poseNearContact(pair_, cutoff, random)
              : kind == 1 ? alignedPose(pair_, cutoff, random)
                          : targetPose(pair_, cutoff, random),
              cutoff);
  }
}

}  // namespace nearfit::test
