#include "tests/bench/feel_scenes.h"

#include <gtest/gtest.h>

#include "core/haptics/virtual_coupling.h"
#include "core/servo/overlap_check.h"
#include "core/servo/tracked_scene.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/places.h"

namespace nearfit::bench::feel_scenes_test {
namespace {

std::vector<FeelEntry> allScenes() {
  std::vector<FeelEntry> entries = generatedFeelScenes();
  for (FeelEntry& entry : sharedFeelScenes(test::sharedFolder()))
    entries.push_back(std::move(entry));
  return entries;
}

Clearance clearanceAt(const FeelScene& feel, const RigidTransform& pose) {
  LmdScratch scratch;
  return findClearance(*feel.scene, *untracked(feel.scene).bounds, pose, 1e-2, scratch);
}

TEST(FeelScenes, PartsAreFreeWhereTheyStartAndCloseToTheOther) {
  for (const FeelEntry& entry : allScenes()) {
    const FeelScene feel = entry.make();
    const Clearance clearance = clearanceAt(feel, feel.motion.start);
    EXPECT_TRUE(clearance.overlapping->empty()) << entry.name;
    EXPECT_GT(clearance.distance, 0.0) << entry.name;
    EXPECT_LT(clearance.distance, 0.5e-3) << entry.name;
  }
}

TEST(FeelScenes, TheHandIsBeyondContactNearlyAllTheTime) {
  for (const FeelEntry& entry : generatedFeelScenes()) {
    const FeelScene feel = entry.make();
    int beyond = 0;
    for (int i = 0; i < 20; ++i)
      beyond += clearanceAt(feel, handAt(feel.motion, kApproachTime + 0.37 * i)).overlapping->empty() ? 0 : 1;
    EXPECT_GE(beyond, 19) << entry.name;
  }
}

TEST(FeelScenes, WithoutTheFolderThereAreNoSharedOnes) {
  EXPECT_TRUE(sharedFeelScenes("").empty());
  EXPECT_TRUE(sharedFeelScenes("/no/such/folder").empty());
}

TEST(SolidScene, TakesTheMassFromTheShape) {
  const glm::dvec3 size(0.1, 0.2, 0.4), centre(1.0, 2.0, 3.0);
  const auto scene = solidScene(test::boxMesh({1.0, 1.0, 1.0}), test::boxMesh(size, centre),
                                {glm::dquat(1.0, 0.0, 0.0, 0.0), {5.0, 0.0, 0.0}});
  ASSERT_EQ(scene->bodies.size(), 1U);
  EXPECT_EQ(scene->moving.worldFromPart.translation.x, 5.0);
  EXPECT_LT(glm::distance(scene->centreInPart, centre), 1e-12);
  // k^2 = (a^2 + b^2) / 12 of a box.
  EXPECT_NEAR(scene->metric.gyration.z, std::sqrt((0.16 + 0.04) / 12.0), 1e-9);
  EXPECT_NEAR(scene->metric.gyration.x, std::sqrt((0.04 + 0.01) / 12.0), 1e-9);
}

}  // namespace
}  // namespace nearfit::bench::feel_scenes_test
