#include "tests/bench/path_scenes.h"

#include <algorithm>
#include <string>
#include <vector>

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
  const double separation = defaultSeparation(made.scene, made.path);
  EXPECT_TRUE(PathCertifier(made.scene, made.path, separation).prove(made.path).isFree()) << made.name;
}

PathBenchScene madeScene(const std::string& name) {
  const std::vector<PathSceneEntry> entries = generatedPathScenes(kPoses);
  const auto found = std::ranges::find(entries, name, &PathSceneEntry::name);
  return found == entries.end() ? PathBenchScene{} : found->make();
}

/// How near the path comes to anything else.
struct NearPath {
  const char* name;
  double gap;  ///< [m]
};

TEST(PathScenes, GeneratedPathsAreFreeAndComeNear) {
  // The play of the peg, what rocks keep, and what the hole leaves the pipe: each in part.
  for (const NearPath& near : {NearPath{"peg", 0.1e-3}, NearPath{"rocks", 0.08}, NearPath{"pipe", 2.6e-3}}) {
    const PathBenchScene made = madeScene(near.name);
    EXPECT_EQ(made.name, near.name);
    EXPECT_EQ(made.path.poses.size(), kPoses);
    expectFree(made);
    EXPECT_LT(leastGap(made, 2.0 * near.gap), near.gap) << made.name;
  }
}

/// The number of parts to which the path comes nearer than the gap at its poses.
std::size_t neighbours(const PathBenchScene& made, double gap) {
  const PathBodies bodies = pathBodies(made.scene, made.path);
  return static_cast<std::size_t>(std::ranges::count_if(bodies.others, [&](const Scene::PartPtr& other) {
    return std::ranges::any_of(bodies.moving, [&](const PathPart& moving) {
      const test::PoseCertifier certifier(other->geometry->mesh, moving.part->geometry->mesh);
      return std::ranges::any_of(made.path.poses, [&](const PathPose& pose) {
        return certifier.surfacesApart(otherFromPart(*other, pose.worldFromLead, moving), gap) < gap;
      });
    });
  }));
}

TEST(PathScenes, AScanPassesNearMostOfTwoHundredParts) {
  const PathBenchScene made = madeScene("among-200");
  const PathBodies bodies = pathBodies(made.scene, made.path);
  EXPECT_EQ(bodies.moving.size(), 1U);
  EXPECT_EQ(bodies.others.size(), 200U);
  EXPECT_EQ(made.path.poses.size(), kPoses);
  expectFree(made);
  constexpr double kBesideChannel = 0.6;
  EXPECT_GT(neighbours(made, kBesideChannel), 150U);
}

TEST(PathScenes, AGroupPassesTheSameWay) {
  const PathBenchScene made = madeScene("group-among-200");
  const PathBodies bodies = pathBodies(made.scene, made.path);
  EXPECT_EQ(bodies.moving.size(), 3U);
  EXPECT_EQ(bodies.others.size(), 200U);
  expectFree(made);
}

TEST(PathScenes, ARecordedPathKeepsFewerPosesAndTouches) {
  const PathBenchScene made = madeScene("recorded-peg");
  EXPECT_GT(made.path.poses.size(), 2U);
  EXPECT_LT(made.path.poses.size(), kPoses);
  expectFree(made);
}

TEST(PathScenes, PathsOfSharedModelsAreFree) {
  for (const PathSceneEntry& entry : sharedPathScenes(test::sharedFolder(), kPoses))
    expectFree(entry.make());
  EXPECT_TRUE(sharedPathScenes({}, kPoses).empty());
}

}  // namespace
}  // namespace nearfit::bench::path_scenes_test
