#include "device/simulated/replay_device.h"

#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/base/error.h"
#include "core/servo/motion_recording.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::replay_device_test {
namespace {

using testing::HasSubstr;

const RigidTransform kQuarter{glm::dquat(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)), {1.0, 2.0, 3.0}};

class Replay : public testing::Test {
 protected:
  /// A hand that goes along x by a millimetre a tick, from where the part is taken.
  std::filesystem::path recording(int rows, double period, double begin = 0.0) const {
    MotionWriter writer(file());
    for (int i = 0; i < rows; ++i) {
      MotionRow row;
      row.time = begin + period * i;
      row.handle = kQuarter;
      row.handle.translation.x += 1e-3 * i;
      row.proxy = {};
      writer.write(row);
    }
    writer.finish();
    return file();
  }
  std::filesystem::path file() const { return folder_.path() / "felt.csv"; }
  std::string refusal(const std::string& content) const {
    try {
      readHandMotion(folder_.write("felt.csv", content));
    } catch (const FileError& e) {
      return e.what();
    }
    return {};
  }

  test::TemporaryFolder folder_;
};

TEST_F(Replay, HandAndTimesAreReadFromWhatIsRecorded) {
  const std::vector<TimedPose> motion = readHandMotion(recording(3, 2e-3, 0.5));
  ASSERT_EQ(motion.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(motion[i].time, 2e-3 * i, 1e-12) << "since the beginning";
    EXPECT_DOUBLE_EQ(motion[i].worldFromHandle.translation.x, 1.0 + 1e-3 * i);
    EXPECT_NEAR(motion[i].worldFromHandle.rotation.z, std::sqrt(0.5), 1e-15);
  }
}

TEST_F(Replay, AFileThatIsCutWithinARowIsReplayedToItsLastWholeRow) {
  std::filesystem::resize_file(recording(3, 1e-3), std::filesystem::file_size(recording(3, 1e-3)) - 1);
  EXPECT_EQ(readHandMotion(file()).size(), 3U) << "only the end of the line is missing";
  const std::string text = test::readBytes(file());
  std::filesystem::resize_file(file(), text.rfind('\n') + 5);
  EXPECT_EQ(readHandMotion(file()).size(), 2U);
}

// A pipe without a writer waited for ever.
TEST_F(Replay, APipeIsRefused) {
  ASSERT_EQ(::mkfifo(file().c_str(), 0600), 0);
  try {
    readHandMotion(file());
    FAIL() << "no error";
  } catch (const FileError& e) {
    EXPECT_EQ(e.where(), file().string());
    EXPECT_THAT(e.problem(), HasSubstr("not a regular file"));
  }
}

TEST_F(Replay, WhatIsNoRecordingIsRefusedWithItsPlace) {
  EXPECT_THAT(refusal(""), HasSubstr("it is empty"));
  EXPECT_THAT(refusal("0,0,0,1,0,0,0\n"), HasSubstr("felt.csv:1: there is no column t_s"));
  const std::string header = "t_s,handle_tx,handle_ty,handle_tz,handle_qw,handle_qx,handle_qy,handle_qz\n";
  EXPECT_THAT(refusal(header), HasSubstr("it has no poses"));
  EXPECT_THAT(refusal(header + "0,0,0,0,1,0,0\n"), HasSubstr("felt.csv:2: it ends before column handle_qz"));
  EXPECT_THAT(refusal(header + "0,0,0,zero,1,0,0,0\n"), HasSubstr("column 4: \"zero\" is not a number"));
  EXPECT_THAT(refusal(header + "0,0,0,0,2,0,0,0\n"), HasSubstr("the quaternion has length 2"));
  EXPECT_THAT(refusal(header + "nan,0,0,0,1,0,0,0\n"), HasSubstr("column 1: \"nan\" is not finite"));
  EXPECT_THAT(refusal(header + "1e300,0,0,0,1,0,0,0\n"), HasSubstr("is not a valid time"));
  EXPECT_THAT(refusal(header + "1,0,0,0,1,0,0,0\n0.5,0,0,0,1,0,0,0\n"),
              HasSubstr("felt.csv:3: its time is earlier"));
  EXPECT_THROW(readHandMotion(folder_.path() / "none.csv"), FileError);
}

TEST_F(Replay, ReadingEndsWhenNobodyWantsItAnyMore) {
  recording(5000, 1e-3);
  EXPECT_THROW(readHandMotion(file(), [](double) { return false; }), Cancelled);
  double last = 0.0;
  readHandMotion(file(), [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_GT(last, 0.5);
  ReplayDevice device(file());
  EXPECT_THROW(device.start(kQuarter, [](double) { return false; }), Cancelled);
  EXPECT_EQ(device.state(), DeviceState::Present);
}

TEST_F(Replay, GivesPosesInOrderWhenTheyAreDueThenEnds) {
  ReplayDevice device(recording(20, 1e-3));
  HandleInput handle;
  EXPECT_FALSE(device.readHandle(handle)) << "not started";
  device.start(kQuarter);
  EXPECT_EQ(device.state(), DeviceState::Armed);
  EXPECT_EQ(device.info().forceAxes, 0);
  EXPECT_NEAR(device.info().reportPeriod, 1e-3, 1e-12);
  EXPECT_FALSE(device.info().isMapped);
  const Nanoseconds begin = monotonicNow();
  double x = 0.0;
  while (device.waitForHandle(monotonicNow() + kNanosecondsPerSecond)) {
    ASSERT_TRUE(device.readHandle(handle));
    EXPECT_GT(handle.pose.translation.x, x);
    x = handle.pose.translation.x;
    EXPECT_GE(handle.age, 0.0);
    // The i-th is due i milliseconds after the beginning, never sooner.
    EXPECT_GE(toSeconds(monotonicNow() - begin), (x - 1.0) - 1e-9);
  }
  EXPECT_NEAR(x, 1.019, 1e-12);
  EXPECT_EQ(device.counters().poses, 20U) << "also those that were late";
  EXPECT_FALSE(device.readHandle(handle));
  EXPECT_EQ(device.state(), DeviceState::Present);
}

TEST_F(Replay, AWayThatBeginsElsewhereIsMovedAsAWhole) {
  ReplayDevice device(recording(2, 1e-3));
  // The part lies unturned at the origin: a millimetre along the recording's x is one along its own -y.
  device.start({});
  HandleInput handle;
  ASSERT_TRUE(device.readHandle(handle));
  EXPECT_NEAR(glm::length(handle.pose.translation), 0.0, 1e-15);
  ASSERT_TRUE(device.waitForHandle(monotonicNow() + kNanosecondsPerSecond));
  ASSERT_TRUE(device.readHandle(handle));
  EXPECT_NEAR(handle.pose.translation.x, 0.0, 1e-15);
  EXPECT_NEAR(handle.pose.translation.y, -1e-3, 1e-15);
}

TEST_F(Replay, SlowRecordingsAreWaitedForAsSlowDevicesAre) {
  ReplayDevice device(recording(3, 1e-2));
  device.start(kQuarter);
  HandleInput handle;
  ASSERT_TRUE(device.readHandle(handle));
  EXPECT_NEAR(handle.patience.hold, 0.020, 1e-9);
  EXPECT_NEAR(handle.patience.silence, 0.040, 1e-9);
}

}  // namespace
}  // namespace nearfit::replay_device_test
