#include "core/verdict/finding_states.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace nearfit::finding_states_test {
namespace {

PartPair pairOf(std::uint32_t part, std::uint32_t other) {
  return {PartId{part}, PartId{other}};
}

PairFinding near(PartPair pair, double distance) {
  PairFinding finding;
  finding.pair = pair;
  finding.distance = distance;
  return finding;
}

PairFinding clash(PartPair pair, double depth) {
  PairFinding finding;
  finding.pair = pair;
  finding.verdict = PairVerdict::Clash;
  finding.clash.emplace().freeing = FreeingTranslation{depth, {1, 0, 0}};
  return finding;
}

SceneCheck checkOf(std::vector<PairFinding> findings) {
  SceneCheck check;
  check.parts = {PartId{1}, PartId{2}, PartId{3}, PartId{4}};
  check.findings = std::move(findings);
  return check;
}

std::vector<PairRecord> saved(const SceneCheck& check, const std::vector<PairRecord>& before = {}) {
  return recordsOf(compareFindings(check, before));
}

TEST(FindingStates, WhatWasNotThereIsNewAndWhatIsAsBeforeIsTheSame) {
  const SceneCheck check = checkOf({near(pairOf(1, 2), 1e-3), clash(pairOf(1, 3), 1e-4)});
  for (const ComparedFinding& finding : compareFindings(check, {})) {
    EXPECT_EQ(finding.change, FindingChange::New);
    EXPECT_EQ(finding.state, FindingState::New);
    EXPECT_FALSE(finding.before);
  }
  for (const ComparedFinding& finding : compareFindings(check, saved(check)))
    EXPECT_EQ(finding.change, FindingChange::Same);
}

TEST(FindingStates, NearerDeeperAndAWorseVerdictAreWorseAndTheContraryIsBetter) {
  const auto changeBetween = [](const PairFinding& before, const PairFinding& now) {
    const std::vector<PairRecord> records = saved(checkOf({before}));
    const SceneCheck check = checkOf({now});
    return compareFindings(check, records).at(0).change;
  };
  const PartPair p = pairOf(1, 2);
  EXPECT_EQ(changeBetween(near(p, 2e-3), near(p, 1e-3)), FindingChange::Worse);
  EXPECT_EQ(changeBetween(near(p, 1e-3), near(p, 2e-3)), FindingChange::Better);
  EXPECT_EQ(changeBetween(near(p, 1e-3), near(p, 1.0005e-3)), FindingChange::Same);
  EXPECT_EQ(changeBetween(near(p, 1e-3), clash(p, 1e-5)), FindingChange::Worse);
  EXPECT_EQ(changeBetween(clash(p, 1e-5), near(p, 1e-3)), FindingChange::Better);
  EXPECT_EQ(changeBetween(clash(p, 1e-4), clash(p, 2e-4)), FindingChange::Worse);
  EXPECT_EQ(changeBetween(clash(p, 2e-4), clash(p, 1e-4)), FindingChange::Better);
}

TEST(FindingStates, AnAcceptedFindingStaysSoUntilItIsWorseOrAnother) {
  const PartPair p = pairOf(1, 2);
  std::vector<PairRecord> records = saved(checkOf({clash(p, 1e-4)}));
  records[0].state = FindingState::Accepted;
  records[0].reason = "pressed in";
  const SceneCheck same = checkOf({clash(p, 1e-4)}), worse = checkOf({clash(p, 2e-4)});
  EXPECT_EQ(compareFindings(same, records).at(0).state, FindingState::Accepted);
  const ComparedFinding now = compareFindings(worse, records).at(0);
  EXPECT_EQ(now.state, FindingState::New);
  EXPECT_EQ(now.reason, "pressed in");
  const SceneCheck shallower = checkOf({clash(p, 5e-5)}), apart = checkOf({near(p, 1e-3)});
  EXPECT_EQ(compareFindings(shallower, records).at(0).state, FindingState::Accepted);
  const ComparedFinding loose = compareFindings(apart, records).at(0);
  EXPECT_EQ(loose.state, FindingState::New) << "a fit was accepted, not a gap";
  EXPECT_EQ(loose.change, FindingChange::Better);
}

TEST(FindingStates, AFindingThatWasAcceptedAndChangedIsCalledSoUntilItIsJudgedAgain) {
  const PartPair p = pairOf(1, 2);
  std::vector<PairRecord> records = saved(checkOf({clash(p, 1e-4)}));
  EXPECT_STREQ(stateWord(records[0].state, records[0].reason), "new");
  records[0].state = FindingState::Accepted;
  records[0].reason = "pressed in";
  EXPECT_STREQ(stateWord(records[0].state, records[0].reason), "accepted");
  const SceneCheck worse = checkOf({clash(p, 2e-4)});
  // The second check finds the same as the first, but nobody has said anything meanwhile.
  for (const FindingChange change : {FindingChange::Worse, FindingChange::Same}) {
    const ComparedFinding now = compareFindings(worse, records).at(0);
    EXPECT_EQ(now.change, change);
    EXPECT_STREQ(stateWord(now.state, now.reason), "changed");
    records = saved(worse, records);
  }
}

TEST(FindingStates, AnAcceptedFindingCannotCreepAwayInSmallSteps) {
  const PartPair p = pairOf(1, 2);
  std::vector<PairRecord> records = saved(checkOf({near(p, 1e-3)}));
  records[0].state = FindingState::Accepted;
  records[0].reason = "room enough";
  double distance = 1e-3;
  int checks = 0;
  while (records[0].state == FindingState::Accepted && checks < 100) {
    // Each step is half of what counts as another distance.
    distance *= 1.0 - 5e-4;
    records = saved(checkOf({near(p, distance)}), records);
    ++checks;
  }
  EXPECT_GE(checks, 2);
  EXPECT_LE(checks, 3);
}

TEST(FindingStates, ChangesAreCountedByKind) {
  const PartPair worse = pairOf(1, 2), better = pairOf(1, 3), gone = pairOf(2, 3), same = pairOf(1, 4);
  const std::vector<PairRecord> records =
      saved(checkOf({near(worse, 2e-3), near(better, 1e-3), near(same, 1e-3), clash(gone, 1e-4)}));
  const SceneCheck now =
      checkOf({near(worse, 1e-3), near(better, 2e-3), near(same, 1e-3), near(pairOf(2, 4), 1e-3)});
  const FindingChanges changes = changesIn(compareFindings(now, records));
  EXPECT_EQ(changes.added, 1U);
  EXPECT_EQ(changes.worse, 1U);
  EXPECT_EQ(changes.better, 1U);
  EXPECT_EQ(changes.gone, 1U);
}

TEST(FindingStates, WhatIsGoneIsFixedAndNewWhenItComesBack) {
  const PartPair p = pairOf(1, 2);
  const SceneCheck there = checkOf({clash(p, 1e-4)}), gone = checkOf({});
  std::vector<PairRecord> records = saved(there);
  const ComparedFinding first = compareFindings(gone, records).at(0);
  EXPECT_EQ(first.change, FindingChange::Gone);
  EXPECT_EQ(first.state, FindingState::Fixed);
  EXPECT_EQ(first.now, nullptr);
  records = saved(gone, records);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].verdict, PairVerdict::Clear);
  EXPECT_EQ(records[0].state, FindingState::Fixed);
  EXPECT_EQ(compareFindings(gone, records).at(0).change, FindingChange::Same);
  const ComparedFinding back = compareFindings(there, records).at(0);
  EXPECT_EQ(back.change, FindingChange::New);
  EXPECT_EQ(back.state, FindingState::New);
}

TEST(FindingStates, WhatWasNotCheckedThisTimeStaysAsItWas) {
  std::vector<PairRecord> records = saved(checkOf({clash(pairOf(1, 2), 1e-4), clash(pairOf(3, 4), 1e-4)}));
  records[0].state = FindingState::Accepted;
  records[0].reason = "why not";
  SceneCheck check = checkOf({});
  check.parts = {PartId{2}, PartId{3}, PartId{4}};
  check.leftOut = {{pairOf(3, 4), 0}};
  const std::vector<PairRecord> after = saved(check, records);
  ASSERT_EQ(after.size(), 2U);
  EXPECT_TRUE(after == records);
}

TEST(FindingStates, TheWorstAndThoseWithAReasonAreKeptWhereThereAreTooMany) {
  std::vector<PairFinding> findings;
  for (std::uint32_t i = 0; i < kMaxPairRecords + 10; ++i)
    findings.push_back(near(pairOf(1, 10 + i), 1e-3 + 1e-9 * i));
  findings.push_back(clash(pairOf(2, 3), 1e-4));
  std::vector<PairRecord> said = saved(checkOf({findings[kMaxPairRecords + 9]}));
  said[0].state = FindingState::Accepted;
  said[0].reason = "seen";
  const std::vector<PairRecord> kept = saved(checkOf(findings), said);
  EXPECT_EQ(kept.size(), kMaxPairRecords);
  EXPECT_TRUE(std::ranges::is_sorted(kept, {}, &PairRecord::pair));
  EXPECT_EQ(kept.back().verdict, PairVerdict::Clash);
  EXPECT_EQ(std::ranges::count(kept, FindingState::Accepted, &PairRecord::state), 1);
}

/// Findings marked as fixed without a word were dropped first.
TEST(FindingStates, ThoseMarkedAsFixedAreKeptUntilTheyAreCheckedAgain) {
  std::vector<PairFinding> findings;
  for (std::uint32_t i = 0; i < kMaxPairRecords + 10; ++i)
    findings.push_back(near(pairOf(1, 10 + i), 1e-3 + 1e-9 * i));
  std::vector<PairRecord> fixed = saved(checkOf({findings.back()}));
  fixed[0].state = FindingState::Fixed;
  // Its parts are hidden in this check.
  findings.pop_back();
  const SceneCheck check = checkOf(findings);
  const std::vector<ComparedFinding> compared = compareFindings(check, fixed);
  const std::vector<PairRecord> kept = recordsOf(compared);
  EXPECT_EQ(kept.size(), kMaxPairRecords);
  EXPECT_EQ(findingsNotKept(compared), 10U);
  EXPECT_EQ(notKeptText(compared),
            "a scene keeps 20000 findings: 10 of the least are not kept, and will be new in the next check");
  EXPECT_EQ(kept.back(), fixed[0]);
}

TEST(FindingStates, WhatIsGoneTakesNoPlaceOfAClash) {
  std::vector<PairFinding> nears, clashes;
  for (std::uint32_t i = 0; i < kMaxPairRecords; ++i) {
    nears.push_back(near(pairOf(1, 10 + i), 1e-3));
    clashes.push_back(clash(pairOf(2, 10 + i), 1e-4));
  }
  SceneCheck check = checkOf({clashes.begin(), clashes.begin() + 100});
  for (std::uint32_t i = 0; i < kMaxPairRecords; ++i)
    check.parts.push_back(PartId{10 + i});
  const std::vector<ComparedFinding> compared = compareFindings(check, saved(checkOf(nears)));
  const std::vector<PairRecord> kept = recordsOf(compared);
  EXPECT_EQ(findingsNotKept(compared), 100U);
  EXPECT_EQ(std::ranges::count(kept, PairVerdict::Clash, &PairRecord::verdict), 100);
  EXPECT_EQ(std::ranges::count(kept, FindingState::Fixed, &PairRecord::state),
            static_cast<std::ptrdiff_t>(kMaxPairRecords - 100));
}

/// An accepted clash that no way out was found of any more stayed accepted.
TEST(FindingStates, AClashWithoutAWayOutIsWorseThanOneWithADepth) {
  PairFinding stuck = clash(pairOf(1, 2), 1e-4);
  stuck.clash->freeing.reset();
  const SceneCheck free = checkOf({clash(pairOf(1, 2), 1e-4)}), caught = checkOf({stuck});
  EXPECT_EQ(compareFindings(caught, saved(free)).at(0).change, FindingChange::Worse);
  EXPECT_EQ(compareFindings(free, saved(caught)).at(0).change, FindingChange::Better);
  EXPECT_EQ(compareFindings(caught, saved(caught)).at(0).change, FindingChange::Same);
}

TEST(FindingStates, AcceptedClashesCountUntilTheyAreWorse) {
  const SceneCheck check =
      checkOf({clash(pairOf(1, 2), 1e-4), clash(pairOf(1, 3), 1e-4), near(pairOf(1, 4), 1e-3)});
  std::vector<PairRecord> records = saved(check);
  EXPECT_EQ(acceptedIn(compareFindings(check, records)), 0U);
  for (PairRecord& record : records) {
    record.state = FindingState::Accepted;
    record.reason = "glued";
  }
  EXPECT_EQ(acceptedIn(compareFindings(check, records)), 2U) << "what is near is not forbidden";
  const SceneCheck deeper = checkOf({clash(pairOf(1, 2), 2e-4), clash(pairOf(1, 3), 1e-4)});
  EXPECT_EQ(acceptedIn(compareFindings(deeper, records)), 1U);
}

}  // namespace
}  // namespace nearfit::finding_states_test
