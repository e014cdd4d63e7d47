// A peg is pressed on a floor through the servo and each maker's plug-in, against a simulated device with mass, friction
// and latency: what ships, from the maker's symbols to the proxy. Its energy and its deepest point depend on how soon the
// servo answers, so maker_contact_stress_test.cpp has them.
#include "tests/makers/maker_contact.h"

#include <gtest/gtest.h>

namespace nearfit::maker_contact_test {
namespace {

class MakerContact : public testing::TestWithParam<test::MakerModel> {};

TEST_P(MakerContact, ComesToRestWhereHandAndFloorBalance) {
  test::MakerBench bench(GetParam());
  const test::ContactOutcome felt = test::pressOnFloor(bench, 0.0, test::patientSafety());
  ASSERT_TRUE(felt.wasReady) << felt.note;
  EXPECT_TRUE(felt.wasFelt) << felt.note;
  EXPECT_TRUE(felt.cameToRest) << felt.force << " N against " << felt.handPull << " N " << felt.note;
  EXPECT_TRUE(felt.wasLetGo) << felt.note;
  EXPECT_EQ(felt.note, "");
}

INSTANTIATE_TEST_SUITE_P(All, MakerContact, testing::ValuesIn(test::kMakerModels),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace nearfit::maker_contact_test
