#include "tests/bench/path_scenes.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/path/path_bodies.h"
#include "core/path/path_certifier.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/places.h"

namespace nearfit::bench::path_scenes_test {
namespace {

/// Few, so that the way between two poses is long.
constexpr std::size_t kPoses = 200;

/// The least gap to any other part at the poses, as far as `most` [m].
double leastGap(const PathBenchScene& made, double most) {
  const PathBodies bodies = pathBodies(made.scene, made.path);
  double least = most;
  for (const PathPart& moving : bodies.moving) {
    for (const Scene::PartPtr& other : bodies.others) {
      const test::PoseCertifier certifier(other->geometry->mesh, moving.part->geometry->mesh);
      for (const PathPose& pose : made.path.poses)
        least =
            std::min(least, certifier.surfacesApart(otherFromPart(*other, pose.worldFromLead, moving), most));
    }
  }
  return least;
}

void expectFree(const PathBenchScene& made) {
  EXPECT_EQ(made.path.poses.size(), kPoses);
  const double separation = defaultSeparation(made.scene, made.path);
  EXPECT_TRUE(PathCertifier(made.scene, made.path, separation).prove(made.path).isFree()) << made.name;
}

TEST(PathScenes, GeneratedPathsAreFreeAndComeNear) {
  const std::vector<PathSceneEntry> entries = generatedPathScenes(kPoses);
  ASSERT_EQ(entries.size(), 3U);
  // The play of the peg, what rocks keep, and what the hole leaves the pipe: each in part.
  const std::vector<double> near{0.1e-3, 0.08, 2.6e-3};
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const PathBenchScene made = entries[i].make();
    EXPECT_EQ(made.name, entries[i].name);
    expectFree(made);
    EXPECT_LT(leastGap(made, 2.0 * near[i]), near[i]) << made.name;
  }
}

TEST(PathScenes, PathsOfSharedModelsAreFree) {
  for (const PathSceneEntry& entry : sharedPathScenes(test::sharedFolder(), kPoses))
    expectFree(entry.make());
  EXPECT_TRUE(sharedPathScenes({}, kPoses).empty());
}

}  // namespace
}  // namespace nearfit::bench::path_scenes_test
