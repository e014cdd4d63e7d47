#include "core/scene/haptic_limits.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace nearfit::haptic_limits_test {
namespace {

/// A number of the settings, by the name that a refusal gives it, with its limits.
struct Limited {
  const char* name;
  std::function<double&(HapticSettings&)> in;
  double lower, upper;
};

const std::vector<Limited>& limitedValues() {
  using S = HapticSettings;
  static const std::vector<Limited> values{
      {"springs.stiffness", [](S& s) -> double& { return s.springs.stiffness; }, 0.0, 1e6},
      {"springs.damping", [](S& s) -> double& { return s.springs.damping; }, 0.0, 1e4},
      {"proxy.margin", [](S& s) -> double& { return s.proxy.margin; }, 1e-9, 1.0},
      {"proxy.friction", [](S& s) -> double& { return s.proxy.friction; }, 0.0, 2.0},
      {"coupling.stiffness", [](S& s) -> double& { return s.coupling.stiffness; }, 0.0, 1e6},
      {"coupling.damping", [](S& s) -> double& { return s.coupling.damping; }, 0.0, 1e4},
      {"coupling.rotationalStiffness", [](S& s) -> double& { return s.coupling.rotationalStiffness; }, 0.0,
       1e6},
      {"coupling.rotationalDamping", [](S& s) -> double& { return s.coupling.rotationalDamping; }, 0.0, 1e4},
      {"weight.gravity", [](S& s) -> double& { return s.weight.gravity.x; }, -std::sqrt(1e6 - 100.0),
       std::sqrt(1e6 - 100.0)},
      {"mapping.scale", [](S& s) -> double& { return s.mapping.scale; }, 1e-3, 1e3},
  };
  return values;
}

/// Far from every limit, with the widest cutoff.
HapticSettings wideSettings() {
  HapticSettings settings;
  settings.springs.cutoff = kMaxCutoff;
  settings.weight.gravity = {0.0, 0.0, -10.0};
  return settings;
}

/// The value that a scene refuses, "none" when it takes the settings.
std::string refusedIn(const HapticSettings& settings) {
  Scene scene;
  try {
    scene.setHaptics(settings);
  } catch (const UsageError& e) {
    EXPECT_TRUE(scene.haptics() == HapticSettings{}) << "a refused change changes nothing";
    EXPECT_FALSE(e.remedy().empty());
    return e.where();
  }
  return "none";
}

TEST(HapticLimits, EveryNumberIsTakenUpToItsLimitsAndRefusedByNameBeyond) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Limited& value : limitedValues()) {
    const auto refusedAt = [&](double number) {
      HapticSettings settings = wideSettings();
      value.in(settings) = number;
      return refusedIn(settings);
    };
    // A rounding inside, as the least gravity is a root.
    const double width = 1e-12 * (value.upper - value.lower);
    EXPECT_EQ(refusedAt(value.lower == 0.0 ? 0.0 : value.lower + width), "none") << value.name;
    EXPECT_EQ(refusedAt(value.upper - width), "none") << value.name;
    for (const double beyond :
         {value.lower - 1e-6 - 2 * width, 1.001 * value.upper, std::nan(""), infinity, -infinity}) {
      EXPECT_EQ(refusedAt(beyond), value.name) << beyond;
    }
  }
}

TEST(HapticLimits, CutoffOutOfItsLimitsIsRefusedByName) {
  HapticSettings settings;
  for (const double cutoff : {0.0, -1.0, 0.99 * kMinCutoff, 1.01 * kMaxCutoff, std::nan("")}) {
    settings.springs.cutoff = cutoff;
    EXPECT_EQ(refusedIn(settings), "springs.cutoff") << cutoff;
  }
  settings.springs.cutoff = kMinCutoff;
  settings.proxy.margin = kMinMargin;
  EXPECT_EQ(refusedIn(settings), "none");
}

TEST(HapticLimits, PrintedLawMayBeStifferAsItsStiffnessIsPerMetre) {
  HapticSettings settings;
  settings.springs.stiffness = 10 * kMaxStiffness;
  EXPECT_EQ(refusedIn(settings), "springs.stiffness");
  settings.springs.law = SpringLaw::Printed;
  EXPECT_EQ(refusedIn(settings), "none");
}

TEST(HapticLimits, MarginAboveTheCutoffIsRefusedWithWhatToDo) {
  HapticSettings settings;
  settings.springs.cutoff = 0.002;
  settings.proxy.margin = 0.002;
  EXPECT_EQ(refusedIn(settings), "none") << "as large as the cutoff is not larger";
  settings.proxy.margin = 0.003;
  try {
    checkHaptics(settings);
    FAIL() << "a margin above the cutoff was taken";
  } catch (const UsageError& e) {
    EXPECT_STREQ(e.what(),
                 "proxy.margin: 0.003 m is greater than the cutoff, 0.002 m; lower the margin, for example "
                 "to 2e-05 m, or raise the cutoff");
  }
}

TEST(HapticLimits, GravityIsHeldByItsLength) {
  HapticSettings settings;
  settings.weight.gravity = {600.0, 0.0, -800.0};
  EXPECT_EQ(refusedIn(settings), "none");
  settings.weight.gravity = {600.0, 1.0, -800.1};
  EXPECT_EQ(refusedIn(settings), "weight.gravity");
}

TEST(HapticLimits, OrientationIsNormalisedOrRefused) {
  HapticSettings settings;
  settings.mapping.orientationOffset = {0.7071, 0.0, 0.0, 0.7071};
  Scene scene;
  scene.setHaptics(settings);
  EXPECT_NEAR(scene.haptics().mapping.orientationOffset.z, std::sqrt(0.5), 1e-15);
  for (const glm::dquat& bad : {glm::dquat(0.0, 0.0, 0.0, 0.0), glm::dquat(1.0, 1.0, 0.0, 0.0),
                                glm::dquat(std::nan(""), 0.0, 0.0, 0.0)}) {
    settings.mapping.orientationOffset = bad;
    EXPECT_EQ(refusedIn(settings), "mapping.orientation");
  }
}

TEST(HapticLimits, DefaultMarginIsAHundredthOfTheCutoffWithinTheLimits) {
  EXPECT_DOUBLE_EQ(defaultMargin(0.005), 5e-5);
  for (const double cutoff : {kMinCutoff, 1e-3, 1.0, 100.0, kMaxCutoff}) {
    HapticSettings settings;
    settings.springs.cutoff = cutoff;
    settings.proxy.margin = defaultMargin(cutoff);
    EXPECT_EQ(refusedIn(settings), "none") << cutoff;
  }
}

}  // namespace
}  // namespace nearfit::haptic_limits_test
