#include "tests/stress/stiffness_limit.h"

#include <gtest/gtest.h>

namespace nearfit::stress::stiffness_limit_test {
namespace {

TEST(StiffnessLimit, OfAHeavyDeviceIsColgates) {
  // 2 b / T, as the device's own time constant is long beside the period.
  EXPECT_NEAR(exactLimit({.mass = 1e3, .damping = 1.0, .period = 1e-3}), 2000.0, 0.01);
  // First order in r = T b / m: 2 b / T (1 + r / 6).
  EXPECT_NEAR(exactLimit({.mass = 0.1, .damping = 1.0, .period = 1e-3}), 2000.0 * (1.0 + 0.01 / 6.0), 0.05);
}

TEST(StiffnessLimit, WithoutRenderedDampingIsWhereTheClosedFormHasIt) {
  for (const LeaningDevice& device : {LeaningDevice{.mass = 0.05, .damping = 1.0, .period = 1e-3},
                                      LeaningDevice{.mass = 0.2, .damping = 2.0, .period = 2e-3},
                                      LeaningDevice{.mass = 0.05, .damping = 5.0, .period = 10e-3}}) {
    EXPECT_NEAR(simulatedLimit(device), exactLimit(device), 0.05 * exactLimit(device));
  }
}

TEST(StiffnessLimit, WithHardlyAnyRenderedDampingTendsToTheClosedForm) {
  const LeaningDevice device{.mass = 0.1, .damping = 1.0, .period = 2e-3};
  LeaningDevice damped = device;
  damped.couplingDamping = 1e-7;
  EXPECT_NEAR(exactLimit(damped), exactLimit(device), 1e-5 * exactLimit(device));
}

TEST(StiffnessLimit, WithRenderedDampingIsWhereTheMapOfATickHasIt) {
  for (const LeaningDevice& device : {LeaningDevice{0.05, 1.0, 1e-3, 0.2}, LeaningDevice{0.2, 2.0, 2e-3, 0.4},
                                      LeaningDevice{0.05, 5.0, 10e-3, 1.0}}) {
    EXPECT_NEAR(simulatedLimit(device), exactLimit(device), 0.05 * exactLimit(device));
  }
}

TEST(StiffnessLimit, EnforcedIsStableAndNotNeedlesslyLow) {
  // Passivity is enough for stability, not necessary. Without rendered damping the two differ by the closed
  // form's factor alone; damping that is rendered counts against the bound, while it calms a device:
  // (b + B) / (b - B) at most lies between.
  for (const double damping : {0.5, 2.0}) {
    for (const double period : {1e-3, 5e-3}) {
      for (const double share : {0.0, 0.2}) {
        const LeaningDevice device{0.1, damping, period, share * damping};
        const double bound = enforcedBound(device);
        EXPECT_TRUE(isCalm(device, bound)) << damping << " N s/m, " << period << " s, " << share;
        const double factor =
            (1.0 + share) / (1.0 - share) * exactLimit({0.1, damping, period}) / (2.0 * damping / period);
        EXPECT_FALSE(isCalm(device, 1.05 * factor * bound))
            << damping << " N s/m, " << period << " s, " << share;
      }
    }
  }
}

TEST(StiffnessLimit, OfSpringsIsWhereTheClosedFormHasItAndTheEnforcedOneIsStable) {
  for (const StressMode mode : {StressMode::Spring, StressMode::Printed, StressMode::Grouped}) {
    for (const double period : {1e-3, 10e-3}) {
      const LeaningDevice device{.mass = 0.1, .damping = 2.0, .period = period, .mode = mode};
      EXPECT_NEAR(simulatedLimit(device), exactLimit(device), 0.05 * exactLimit(device))
          << nameOf(mode) << ", " << period << " s";
      EXPECT_TRUE(isCalm(device, enforcedBound(device))) << nameOf(mode) << ", " << period << " s";
      EXPECT_FALSE(isCalm(device, 1.1 * exactLimit(device))) << nameOf(mode) << ", " << period << " s";
    }
  }
}

}  // namespace
}  // namespace nearfit::stress::stiffness_limit_test
