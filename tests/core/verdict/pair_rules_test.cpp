#include "core/verdict/pair_rules.h"

#include <array>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace nearfit::pair_rules_test {
namespace {

constexpr std::size_t kBolt = 0, kPlate = 1, kNut = 2, kPin = 3;
const std::array<RuledPart, 4> kParts{
    {{"Bolt 1", GroupId{1}}, {"Plate", {}}, {"Nut", GroupId{1}}, {"Pin", {}}}};

TEST(PairRules, PairsAreLeftOutByNamesInEitherOrder) {
  const std::vector<PairRule> rules{{PairRuleKind::LeaveOut, "Bolt*", "Plate"}};
  const PairRules book(rules, kParts);
  EXPECT_EQ(book.leavingOut(kBolt, kPlate), 0U);
  EXPECT_EQ(book.leavingOut(kPlate, kBolt), 0U);
  EXPECT_FALSE(book.leavingOut(kBolt, kNut));
}

TEST(PairRules, PartsOfOneGroupAreLeftOutButNotThoseInNone) {
  const std::vector<PairRule> rules{{PairRuleKind::Touching, "*", "*"}, {PairRuleKind::SameGroup}};
  const PairRules book(rules, kParts);
  EXPECT_EQ(book.leavingOut(kBolt, kNut), 1U);
  EXPECT_FALSE(book.leavingOut(kBolt, kPlate));
  EXPECT_FALSE(book.leavingOut(kPlate, kPin));
}

TEST(PairRules, TouchingIsAllowedWhereItIsMeantAndAClashIsNot) {
  const std::vector<PairRule> rules{{PairRuleKind::Touching, "Nut", "Plate"}};
  const PairRules book(rules, kParts);
  EXPECT_EQ(book.allowing(kPlate, kNut, PairVerdict::Touching, 0.0), 0U);
  EXPECT_FALSE(book.allowing(kPlate, kNut, PairVerdict::Clash, 1e-9));
  EXPECT_FALSE(book.allowing(kPlate, kBolt, PairVerdict::Touching, 0.0));
}

TEST(PairRules, APressFitAllowsAClashUpToItsInterferenceAndNoPartInsideAnother) {
  const std::vector<PairRule> rules{{PairRuleKind::PressFit, "Pin", "*", 1e-5},
                                    {PairRuleKind::PressFit, "Pin", "Plate", 3e-5}};
  const PairRules book(rules, kParts);
  EXPECT_EQ(book.allowedInterference(kPlate, kPin), 3e-5);
  EXPECT_EQ(book.allowedInterference(kPin, kNut), 1e-5);
  EXPECT_EQ(book.allowedInterference(kBolt, kNut), 0.0);
  EXPECT_EQ(book.allowing(kPin, kPlate, PairVerdict::Clash, 1e-5), 0U);
  EXPECT_EQ(book.allowing(kPin, kPlate, PairVerdict::Clash, 2e-5), 1U);
  EXPECT_FALSE(book.allowing(kPin, kPlate, PairVerdict::Clash, 4e-5));
  EXPECT_EQ(book.allowing(kPin, kNut, PairVerdict::Touching, 0.0), 0U);
  EXPECT_FALSE(book.allowing(kPin, kPlate, PairVerdict::Contained, 1e-6));
}

TEST(PairRules, InvalidRulesAreRefused) {
  const std::vector<PairRule> rules{{PairRuleKind::LeaveOut, "", "*"}};
  EXPECT_THROW(PairRules(rules, kParts), UsageError);
}

}  // namespace
}  // namespace nearfit::pair_rules_test
