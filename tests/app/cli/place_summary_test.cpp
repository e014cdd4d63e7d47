#include "app/cli/place_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace nearfit::cli::place_summary_test {
namespace {

using ::testing::HasSubstr;

/// A run in the proxy mode that ended with these numbers.
class PlaceSummaryOfAProxy : public ::testing::Test {
 protected:
  PlaceSummaryOfAProxy() {
    parameters_.limits.damping = 1.0;
    parameters_.limits.rotationalDamping = 1e-3;
    result_.coupling = {.stiffness = 640.0, .damping = 0.2, .rotationalStiffness = 0.5};
  }
  std::string text() const { return summaryText(summary()); }
  nlohmann::json json() const { return nlohmann::json::parse(summaryJson(summary())); }
  nlohmann::json coupling() const { return json()["proxy"]["coupling"]; }

  ServoParameters parameters_;
  PlaceResult result_;

 private:
  PlaceSummary summary() const { return {part_, 1, 0, parameters_, result_, none_, none_}; }
  std::string part_ = "peg", none_;
};

// It told the bound of 1 kHz whatever the device's rate: twice what was enforced at 500 Hz.
TEST_F(PlaceSummaryOfAProxy, TellsTheBoundAtTheMeasuredPeriod) {
  // K <= 2 (b - B) / T.
  result_.period = 1e-3;
  EXPECT_THAT(text(), HasSubstr("1600 N/m; 2 N m/rad: max for passivity at 1 ms with the device's damping"));
  result_.period = 2e-3;
  EXPECT_THAT(text(), HasSubstr("800 N/m; 1 N m/rad: max for passivity at 2 ms with the device's damping"));
  EXPECT_DOUBLE_EQ(coupling()["stiffness_bound"].get<double>(), 800.0);
  EXPECT_DOUBLE_EQ(coupling()["rotational_stiffness_bound"].get<double>(), 1.0);
  EXPECT_DOUBLE_EQ(coupling()["period"].get<double>(), 2e-3);
}

TEST_F(PlaceSummaryOfAProxy, TellsTheBoundAtTheHandleOverAScale) {
  // The handle goes twice as far as the device: half its damping against shifts, twice against turns.
  parameters_.haptics.mapping.scale = 2.0;
  result_.period = 1e-3;
  EXPECT_DOUBLE_EQ(coupling()["stiffness_bound"].get<double>(), 2.0 * (0.5 - 0.2) / 1e-3);
  EXPECT_DOUBLE_EQ(coupling()["rotational_stiffness_bound"].get<double>(), 2.0 * 2e-3 / 1e-3);
}

TEST_F(PlaceSummaryOfAProxy, TellsOfAMinDistanceThatIsOnlyABound) {
  result_.leastDistance = 0.00026;
  result_.leastDistanceTime = 1.5;
  EXPECT_THAT(text(), HasSubstr("min 0.00026 m at 1.500 s"));
  EXPECT_EQ(json()["least_distance_is_bound"], false);
  result_.isLeastDistanceBound = true;
  EXPECT_THAT(text(), HasSubstr("min at least 0.00026 m at 1.500 s"));
  EXPECT_EQ(json()["least_distance_is_bound"], true);
}

}  // namespace
}  // namespace nearfit::cli::place_summary_test
