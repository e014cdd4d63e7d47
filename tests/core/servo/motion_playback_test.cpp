#include "core/servo/motion_playback.h"

#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::motion_playback_test {
namespace {

/// Rows at 0, 0.1, ... s, whose part is as far along x.
std::vector<MotionRow> rowsOf(std::size_t count) {
  std::vector<MotionRow> rows(count);
  for (std::size_t i = 0; i < count; ++i) {
    rows[i].time = 0.1 * static_cast<double>(i);
    rows[i].proxy.translation.x = rows[i].time;
  }
  return rows;
}

TEST(MotionPlayback, TheRowThatCountsIsTheLastThatIsNoLater) {
  MotionPlayback playback(rowsOf(11));
  EXPECT_EQ(playback.duration(), 1.0);
  for (double time = 0.0; time <= 1.0; time += 0.013) {
    playback.seek(time);
    std::size_t expected = 0;
    while (expected + 1 < 11 && playback.rows()[expected + 1].time <= time)
      ++expected;
    EXPECT_EQ(playback.index(), expected) << time;
    EXPECT_EQ(playback.time(), time);
  }
}

TEST(MotionPlayback, ATimeBeyondItsEndsIsAtThem) {
  MotionPlayback playback(rowsOf(11));
  playback.seek(99.0);
  EXPECT_EQ(playback.index(), 10U);
  EXPECT_EQ(playback.time(), 1.0);
  playback.seek(-1.0);
  EXPECT_EQ(playback.index(), 0U);
  playback.seek(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(playback.time(), 0.0);
}

TEST(MotionPlayback, StepsGoRowByRowAndStopAtTheEnds) {
  MotionPlayback playback(rowsOf(4));
  playback.step(-1);
  EXPECT_EQ(playback.index(), 0U);
  playback.step(1);
  EXPECT_EQ(playback.row().proxy.translation.x, 0.1);
  EXPECT_EQ(playback.time(), 0.1);
  playback.step(10);
  EXPECT_EQ(playback.index(), 3U);
}

TEST(MotionPlayback, ItGoesOnAtItsSpeedAndEndsOrBeginsAgain) {
  MotionPlayback playback(rowsOf(11));
  playback.setSpeed(0.5);
  EXPECT_TRUE(playback.advance(0.5));
  EXPECT_DOUBLE_EQ(playback.time(), 0.25);
  playback.setSpeed(4.0);
  EXPECT_FALSE(playback.advance(1.0));
  EXPECT_EQ(playback.time(), 1.0);
  playback.setLooping(true);
  EXPECT_TRUE(playback.advance(0.05));
  EXPECT_NEAR(playback.time(), 0.2, 1e-12);
  playback.setSpeed(0.0);
  EXPECT_EQ(playback.speed(), MotionPlayback::kMinSpeed);
  playback.setSpeed(std::nan(""));
  EXPECT_EQ(playback.speed(), MotionPlayback::kMinSpeed);
}

TEST(MotionPlayback, ASingleRowIsARecordingToo) {
  MotionPlayback playback(rowsOf(1));
  EXPECT_FALSE(playback.advance(1.0));
  playback.setLooping(true);
  EXPECT_TRUE(playback.advance(1.0));
  EXPECT_EQ(playback.time(), 0.0);
}

TEST(MotionPlayback, ARowIsShownAsTheSnapshotThatItWasTakenFrom) {
  Part part = test::partOf(test::geometryOf(test::tetrahedronMesh(), {0.0, 0.0, 0.5}), "peg");
  part.id = PartId{7};
  const auto original = std::make_unique<ServoSnapshot>();
  original->time = 1.5;
  original->proxy = {glm::dquat(std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0), {1.0, 2.0, 3.0}};
  original->handle.translation = {4.0, 5.0, 6.0};
  original->wrench = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  original->distance = 0.25;
  original->contactCount = 3;
  original->tickTime = 1e-4;
  const auto shown = std::make_unique<ServoSnapshot>();
  shown->storedLmds = 9;
  takeRow(motionRow(*original), part, *shown);
  EXPECT_EQ(formatMotionRow(motionRow(*shown)), formatMotionRow(motionRow(*original)));
  EXPECT_EQ(shown->moving, part.id);
  EXPECT_EQ(shown->storedLmds, 0U);
  // A quarter turn about x takes z to -y.
  EXPECT_LT(glm::distance(shown->centre, glm::dvec3(1.0, 1.5, 3.0)), 1e-12);
}

}  // namespace
}  // namespace nearfit::motion_playback_test
