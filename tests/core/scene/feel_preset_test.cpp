#include "core/scene/feel_preset.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/haptics/virtual_coupling.h"
#include "core/scene/haptic_limits.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::feel_preset_test {
namespace {

const FeelPreset& usual(std::size_t i) {
  return usualFeelPresets().at(i);
}

/// Settings of which nothing is as in a new scene.
HapticSettings unusual() {
  HapticSettings settings;
  settings.mode = HapticMode::Springs;
  settings.springs = {0.02, 333.0, 0.5, SpringLaw::Linear};
  settings.proxy = {2e-4, 0.3};
  settings.coupling = {false, 777.0, 0.2, 0.7, 2e-4};
  settings.weight = {true, true, {0.0, -9.0, 0.0}};
  settings.mapping.scale = 3.0;
  settings.mapping.translationLocks = {true, false, false};
  return settings;
}

TEST(FeelPreset, EachUsualOneIsStifferThanTheOneBefore) {
  const HapticSettings scene;
  const DeviceLimits device;
  double spring = 0.0, coupling = 0.0, turn = 0.0;
  for (const FeelPreset& preset : usualFeelPresets()) {
    EXPECT_NO_THROW(checkFeelPreset(preset));
    const HapticSettings made = withPreset(scene, preset);
    const CouplingState felt = boundedCoupling(made.coupling, device, {}, 1e-3);
    EXPECT_GT(made.springs.stiffness, spring) << preset.name;
    EXPECT_GT(felt.stiffness, coupling) << preset.name;
    EXPECT_GT(felt.rotationalStiffness, turn) << preset.name;
    spring = made.springs.stiffness;
    coupling = felt.stiffness;
    turn = felt.rotationalStiffness;
  }
}

TEST(FeelPreset, ANewSceneFeelsStiff) {
  EXPECT_TRUE(isInForce(usual(2), HapticSettings{}));
  EXPECT_FALSE(isInForce(usual(0), HapticSettings{}));
  // Numbers that nobody feels while the device's bound decides make no difference.
  HapticSettings settings;
  settings.coupling.stiffness = 5.0;
  EXPECT_TRUE(isInForce(usual(2), settings));
  // So do springs where there are none, and the coupling where there are springs.
  settings.springs.stiffness = 3.0;
  EXPECT_TRUE(isInForce(usual(2), settings));
  settings.mode = HapticMode::Springs;
  EXPECT_FALSE(isInForce(usual(2), settings));
  settings.springs = usual(2).settings.springs;
  settings.coupling.isAutomatic = false;
  EXPECT_TRUE(isInForce(usual(2), settings));
}

TEST(FeelPreset, AUsualOneChangesTheStiffnessAlone) {
  const HapticSettings before = unusual();
  HapticSettings expected = before;
  expected.coupling = usual(0).settings.coupling;
  expected.springs.stiffness = usual(0).settings.springs.stiffness;
  expected.springs.damping = 0.0;
  EXPECT_EQ(withPreset(before, usual(0)), expected);
}

TEST(FeelPreset, AUsualOneKeepsTheChoiceOfSpringsAndOnesOwnBringsIt) {
  HapticSettings before = unusual();
  before.springs.onePerArea = true;
  EXPECT_TRUE(withPreset(before, usual(0)).springs.onePerArea);
  FeelPreset own;
  own.name = "Own";
  own.settings = unusual();
  EXPECT_FALSE(withPreset(before, own).springs.onePerArea);
}

TEST(FeelPreset, AUsualOnePushesAsMuchByEitherLaw) {
  HapticSettings printed;
  printed.mode = HapticMode::Springs;
  printed.springs.law = SpringLaw::Printed;
  printed.springs.cutoff = 0.02;
  const HapticSettings made = withPreset(printed, usual(1));
  EXPECT_EQ(made.springs.law, SpringLaw::Printed);
  // k c of the linear law, and k c^2 / 4 of the printed one.
  EXPECT_NEAR(made.springs.stiffness * 0.02 * 0.02 / 4.0, usual(1).settings.springs.stiffness * 0.02, 1e-12);
  EXPECT_TRUE(isInForce(usual(1), made));
}

TEST(FeelPreset, OnesOwnIsAllButWhatBelongsToSceneAndDevice) {
  const FeelPreset own{"Mine", unusual()};
  HapticSettings scene;
  scene.springs.cutoff = 0.005;
  scene.mapping.scale = 0.5;
  scene.weight.gravity = {0.0, 0.0, -1.6};
  HapticSettings expected = unusual();
  expected.springs.cutoff = 0.005;
  expected.proxy.margin = scene.proxy.margin;
  expected.weight.gravity = scene.weight.gravity;
  expected.mapping = scene.mapping;
  const HapticSettings made = withPreset(scene, own);
  EXPECT_EQ(made, expected);
  EXPECT_TRUE(isInForce(own, made));
  HapticSettings changed = made;
  changed.springs.damping += 0.1;
  EXPECT_FALSE(isInForce(own, changed));
}

TEST(FeelPreset, WhatIsWrittenIsReadToTheLastBit) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "new" / "presets.json";
  EXPECT_TRUE(readFeelPresets(file).presets.empty());
  const std::vector<FeelPreset> presets{{"Mine", unusual()}, {"Größe ½", {}}};
  writeFeelPresets(file, presets);
  const FeelPresetFile read = readFeelPresets(file);
  EXPECT_EQ(read.presets, presets);
  EXPECT_TRUE(read.problems.empty());
}

TEST(FeelPreset, WhatIsDamagedIsLeftOutAndTheRestIsThere) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "presets.json";
  const std::vector<FeelPreset> presets{{"One", unusual()}, {"Two", {}}, {"Three", {}}};
  writeFeelPresets(file, presets);
  std::string text = test::readBytes(file);
  const auto spoil = [&text](const std::string& what, const std::string& by) {
    text.replace(text.find(what), what.size(), by);
  };
  spoil("333", "-1");
  spoil("Three", "Two");
  const FeelPresetFile read = readFeelPresets(folder.write("damaged.json", text));
  ASSERT_EQ(read.presets.size(), 1U);
  EXPECT_EQ(read.presets[0], presets[1]);
  ASSERT_EQ(read.problems.size(), 2U);
  EXPECT_NE(read.problems[0].find("presets[0]"), std::string::npos) << read.problems[0];
  EXPECT_NE(read.problems[1].find("presets[2]"), std::string::npos) << read.problems[1];
}

TEST(FeelPreset, WhatIsNoSuchFileIsAnErrorWithItsReason) {
  const test::TemporaryFolder folder;
  for (const char* text : {"", "{", "[]", "{\"format\": \"other\"}", "{\"format\": \"nearfit feel presets\"}",
                           "{\"format\": \"nearfit feel presets\", \"version\": 2, \"presets\": []}",
                           "{\"format\": \"nearfit feel presets\", \"version\": 1, \"presets\": 3}"}) {
    EXPECT_THROW(readFeelPresets(folder.write("presets.json", text)), FileError) << text;
  }
}

TEST(FeelPreset, NamesAndNumbersAreChecked) {
  EXPECT_THROW(checkFeelPreset({"", {}}), UsageError);
  EXPECT_THROW(checkFeelPreset({"a\nb", {}}), UsageError);
  EXPECT_THROW(checkFeelPreset({std::string(kMaxFeelPresetNameBytes + 1, 'a'), {}}), UsageError);
  FeelPreset driving{"Driving", {}};
  driving.settings.springs.damping = -1.0;
  EXPECT_THROW(checkFeelPreset(driving), UsageError);
}

}  // namespace
}  // namespace nearfit::feel_preset_test
