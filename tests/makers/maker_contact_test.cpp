// A peg is pressed on a floor through the servo and each maker's plug-in, against a simulated device with mass, friction
// and latency: what ships, from the maker's symbols to the proxy.
#include "tests/makers/maker_contact.h"

#include <gtest/gtest.h>

namespace nearfit::maker_contact_test {
namespace {

/// Its friction holds the handle a little off where the forces would balance [N].
constexpr double kBalanceSlack = 1.2 * test::StandinDevice::kFriction;
/// Motors that push the handle out of a floor which it is in by a sample's way give that much, and no more: a tenth of
/// what holds a hand of 100 g at 15 cm/s [J].
constexpr double kMaxEnergy = 1e-4;

class MakerContact : public testing::TestWithParam<test::MakerModel> {};

TEST_P(MakerContact, ComesToRestWhereHandAndFloorBalanceAndGivesNoEnergy) {
  test::MakerBench bench(GetParam());
  const test::ContactOutcome felt = test::pressOnFloor(bench, 0.0);
  ASSERT_TRUE(felt.wasReady) << felt.note;
  EXPECT_TRUE(felt.wasFelt) << felt.note;
  EXPECT_TRUE(felt.cameToRest) << felt.note;
  EXPECT_NEAR(felt.force, felt.handPull, kBalanceSlack);
  EXPECT_GT(felt.deepest, -test::kContactTarget) << "the floor holds the hand up";
  EXPECT_LT(felt.maxEnergyGiven, kMaxEnergy);
  EXPECT_TRUE(felt.wasLetGo) << felt.note;
  EXPECT_EQ(felt.note, "");
}

INSTANTIATE_TEST_SUITE_P(All, MakerContact, testing::ValuesIn(test::kMakerModels),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace nearfit::maker_contact_test
