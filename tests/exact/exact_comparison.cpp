#include "tests/exact/exact_comparison.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/query/lmd_query.h"
#include "core/proximity/tracking/candidate_list.h"
#include "tests/exact/target_pose.h"

namespace nearfit::test {
namespace {

/// One for each instruction set that the machine has: megabytes, kept.
std::vector<LmdScratch>& scratchOfEachLevel() {
  thread_local std::vector<LmdScratch> all = [] {
    std::vector<LmdScratch> made;
    for (const SimdLevel level : availableSimdLevels())
      made.emplace_back(4096, level);
    return made;
  }();
  return all;
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
    : pair_(pair), scene_(pair.scene), part_(pair.part), judge_(pair) {}

void ExactComparison::checkSet(const std::vector<Lmd>& found, const std::vector<ExactMinimum>& exact,
                               double cutoff, const std::string& where) {
  for (const std::string& fault : judge_.faults(found, exact, cutoff, tally_))
    ADD_FAILURE() << where << ": " << fault;
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
      EXPECT_EQ(other[i].isMarginal, found[i].isMarginal) << what << ' ' << describe(pose);
    }
  };
  std::vector<Lmd> other(found.size() + 1);
  for (LmdScratch& scratch : scratchOfEachLevel())
    expectSame(findLmds(scene_, part_, pose, cutoff, scratch, other), other, "instruction set");
  thread_local LmdScratch scratch(4096);
  CandidateList list;
  RigidTransform start = pose;
  // Elsewhere, but no farther than there are bodies: a cutoff may be any number.
  const double away = std::min(cutoff, size());
  start.translation += glm::dvec3(0.3, -0.2, 0.1) * away;
  list.build({scene_, part_, start, cutoff}, {{}, {0.5 * away, 1e-3}}, scratch, {1U << 16, 1U << 22});
  if (!list.isUsable()) return;  // Thousands of features at one place; it says that it covers nothing.
  const std::optional<LmdResult> listed = list.query(pose, cutoff, scratch, other);
  ASSERT_TRUE(listed) << list.size() << " pairs, " << describe(pose);
  expectSame(*listed, other, "candidate list");
}

void ExactComparison::checkPose(const RigidTransform& pose, double cutoff) {
  ++tally_.poses;
  const std::vector<ExactMinimum> exact = judge_.minimaAt(pose, cutoff);
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
