#include "core/servo/motion_recording.h"

#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/servo/motion_reader.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::motion_recording_test {
namespace {

using testing::HasSubstr;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);)
    parts.push_back(part);
  return parts;
}

MotionRow sampleRow() {
  MotionRow row;
  row.time = 0.001;
  row.handle = {glm::dquat(0.1, 0.2, 0.3, 0.4), {1.0, 2.0, 3.0}};
  row.proxy = {glm::dquat(0.5, 0.6, 0.7, 0.8), {4.0, 5.0, 6.0}};
  row.wrench = {{-1.0, -2.0, -3.0}, {-4.0, -5.0, -6.0}};
  row.lmds = 17;
  row.distance = 1.0 / 3.0;
  row.queryTime = 12.3456e-6;
  row.tickTime = 20e-6;
  row.lateBodies = 3;
  row.energyToHand = -2.5e-4;
  row.subSteps = 4;
  row.shortenedSteps = 5;
  row.refusedSteps = 6;
  row.constraints = 7;
  row.contacts = 8;
  row.overlapping = 9;
  row.proxyTime = 1.2341e-6;
  row.lateness = 45.6781e-6;
  row.wrenchTime = 5.4321e-6;
  row.isClamped = row.isTruncated = row.isBehind = row.isDistanceBound = true;
  row.fault = ServoFault::WrenchNotFinite;
  row.grip = 0.75;
  return row;
}

TEST(MotionRecording, TheHeaderNamesTheColumnsInOrder) {
  const std::vector<std::string> expected{
      "t_s",       "handle_tx", "handle_ty",   "handle_tz", "handle_qw",   "handle_qx", "handle_qy",
      "handle_qz", "proxy_tx",  "proxy_ty",    "proxy_tz",  "proxy_qw",    "proxy_qx",  "proxy_qy",
      "proxy_qz",  "force_x",   "force_y",     "force_z",   "torque_x",    "torque_y",  "torque_z",
      "lmds",      "distance",  "query_us",    "tick_us",   "late_bodies", "energy",    "sub_steps",
      "shortened", "refused",   "constraints", "contacts",  "released",    "proxy_us",  "clamped",
      "fault",     "truncated", "late_us",     "wrench_us", "behind",      "grip",      "distance_bound"};
  EXPECT_EQ(split(std::string(motionHeader()), ','), expected);
}

TEST(MotionRecording, ARowHasItsValuesUnderTheirColumns) {
  const std::vector<std::string> columns = split(formatMotionRow(sampleRow()), ',');
  const std::vector<double> expected{0.001,     1,      2,   3,   0.1,     0.2,   0.3, 0.4,  4,  5,  6,
                                     0.5,       0.6,    0.7, 0.8, -1,      -2,    -3,  -4,   -5, -6, 17,
                                     1.0 / 3.0, 12.346, 20,  3,   -2.5e-4, 4,     5,   6,    7,  8,  9,
                                     1.234,     1,      2,   1,   45.678,  5.432, 1,   0.75, 1};
  ASSERT_EQ(columns.size(), expected.size());
  for (std::size_t i = 0; i < columns.size(); ++i)
    EXPECT_EQ(std::stod(columns[i]), expected[i]) << i;
}

TEST(MotionRecording, NothingWithinTheCutoffIsAnInfiniteDistance) {
  MotionRow row = sampleRow();
  row.distance = std::numeric_limits<double>::infinity();
  EXPECT_EQ(split(formatMotionRow(row), ',').at(22), "inf");
}

TEST(MotionRecording, TheGripOfADeviceWithoutAGripperIsNoNumber) {
  MotionRow row = sampleRow();
  row.grip.reset();
  EXPECT_EQ(split(formatMotionRow(row), ',').at(40), "nan");
}

TEST(MotionRecording, ARowIsTakenFromASnapshot) {
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->time = 1.5;
  snapshot->handle.translation.x = 2.5;
  snapshot->proxy.translation.x = 3.5;
  snapshot->wrench.force.x = 4.5;
  snapshot->unclampedWrench.force.x = 99.0;
  snapshot->lmdCount = 700;
  snapshot->storedLmds = 512;
  snapshot->distance = 5.5;
  snapshot->isDistanceBound = true;
  snapshot->queryTime = 6.5;
  snapshot->tickTime = 7.5;
  snapshot->isClamped = true;
  snapshot->energyToHand = 8.5;
  snapshot->proxyTime = 9.5;
  snapshot->wrenchTime = 10.5;
  snapshot->isBehind = true;
  snapshot->grip = 0.25;
  snapshot->subSteps = 11;
  snapshot->shortenedSteps = 12;
  snapshot->refusedSteps = 13;
  snapshot->constraintCount = 14;
  snapshot->contactCount = 15;
  snapshot->storedContacts = 1;
  snapshot->overlappingCount = 16;
  snapshot->fault = ServoFault::WrenchNotFinite;
  const MotionRow row = motionRow(*snapshot, 17.5);
  EXPECT_EQ(row.time, 1.5);
  EXPECT_EQ(row.handle.translation.x, 2.5);
  EXPECT_EQ(row.proxy.translation.x, 3.5);
  EXPECT_EQ(row.wrench.force.x, 4.5) << "as sent";
  EXPECT_EQ(row.lmds, 700U);
  EXPECT_EQ(row.distance, 5.5);
  EXPECT_TRUE(row.isDistanceBound);
  EXPECT_EQ(row.queryTime, 6.5);
  EXPECT_EQ(row.tickTime, 7.5);
  EXPECT_TRUE(row.isClamped);
  EXPECT_FALSE(row.isTruncated);
  EXPECT_EQ(row.fault, ServoFault::WrenchNotFinite);
  EXPECT_EQ(row.energyToHand, 8.5);
  EXPECT_EQ(row.proxyTime, 9.5);
  EXPECT_EQ(row.wrenchTime, 10.5);
  EXPECT_TRUE(row.isBehind);
  EXPECT_EQ(row.grip, 0.25);
  EXPECT_EQ(row.subSteps, 11U);
  EXPECT_EQ(row.shortenedSteps, 12U);
  EXPECT_EQ(row.refusedSteps, 13U);
  EXPECT_EQ(row.constraints, 14U);
  EXPECT_EQ(row.contacts, 15U);
  EXPECT_EQ(row.overlapping, 16U);
  EXPECT_EQ(row.lateness, 17.5);
}

TEST(MotionWriter, TheFileAppearsWholeWhenFinished) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "record.csv";
  MotionWriter writer(file);
  writer.write(sampleRow());
  writer.write(sampleRow());
  EXPECT_FALSE(std::filesystem::exists(file));
  writer.finish();
  const std::vector<std::string> lines = split(test::readBytes(file), '\n');
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], motionHeader());
  EXPECT_EQ(lines[1], formatMotionRow(sampleRow()));
  const auto entries = std::distance(std::filesystem::directory_iterator(folder.path()), {});
  EXPECT_EQ(entries, 1) << "no temporary file is left";
}

TEST(MotionWriter, AnUnfinishedRecordingLeavesTheOldFileAndNothingElse) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("record.csv", "old");
  {
    MotionWriter writer(file);
    writer.write(sampleRow());
  }
  EXPECT_EQ(test::readBytes(file), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

/// Rows a millisecond apart, until writing fails or there are so many.
void writeRows(MotionWriter& writer, int count) {
  MotionRow row = sampleRow();
  row.handle.rotation = row.proxy.rotation = glm::dquat(1.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < count; ++i) {
    row.time = 1e-3 * i;
    writer.write(row);
  }
}

/// The other files of a folder.
std::vector<std::filesystem::path> filesBeside(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(file.parent_path())) {
    if (entry.path() != file) files.push_back(entry.path());
  }
  return files;
}

TEST(MotionWriter, WhatWasWrittenBeforeTheDiskWasFullIsKeptInWholeRows) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "record.csv";
  // Within a block and within a row, in several ways.
  for (const rlim_t space : {20'000, 65'536, 100'000, 150'001, 150'002, 150'113}) {
    MotionWriter writer(file);
    {
      const test::FileSizeLimit full(space);
      EXPECT_THROW(
          {
            writeRows(writer, 2000);
            writer.finish();
          },
          FileError);
    }
    const std::optional<double> kept = writer.keepWritten();
    ASSERT_TRUE(kept);
    const Recording read = readRecording(file);
    EXPECT_FALSE(read.isCut);
    EXPECT_EQ(read.rows.back().time, *kept);
    const std::string text = test::readBytes(file);
    EXPECT_EQ(text.back(), '\n');
    EXPECT_LE(text.size(), space);
    EXPECT_GT(text.size() + 400, space) << "no row that was whole is lost";
    EXPECT_TRUE(filesBeside(file).empty());
  }
}

TEST(MotionWriter, WhereNoRowWasWrittenNothingIsKeptAndTheOldFileStays) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("record.csv", "old");
  {
    MotionWriter writer(file);
    writeRows(writer, 3);
    const test::FileSizeLimit full(400);
    EXPECT_THROW(writer.finish(), FileError);
    EXPECT_FALSE(writer.keepWritten());
  }
  EXPECT_EQ(test::readBytes(file), "old");
  EXPECT_TRUE(filesBeside(file).empty());
}

TEST(MotionWriter, AKilledProgramLeavesWhatItWroteUnderANameThatTellsAndLaterOnesLeaveItAlone) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "record.csv";
  const auto dieRecording = [&] {
    const ::pid_t child = ::fork();
    if (child == 0) {
      MotionWriter writer(file);
      writeRows(writer, 2000);
      ::kill(::getpid(), SIGKILL);
    }
    ::waitpid(child, nullptr, 0);
  };
  dieRecording();
  const std::filesystem::path left = folder.path() / "record.unfinished.csv";
  ASSERT_THAT(filesBeside(file), testing::ElementsAre(left));
  const Recording read = readRecording(left);
  EXPECT_GT(read.rows.size(), 1500U) << "all but the last tenths of a second";
  dieRecording();
  EXPECT_THAT(filesBeside(file),
              testing::UnorderedElementsAre(left, folder.path() / "record.unfinished-2.csv"));
  MotionWriter writer(file);
  writeRows(writer, 3);
  writer.finish();
  EXPECT_EQ(readMotion(file).size(), 3U);
  EXPECT_EQ(readMotion(left).size(), read.rows.size());
}

TEST(MotionWriter, ANameAsLongAsNamesCanBeIsNoObstacle) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / (std::string(251, 'n') + ".csv");
  MotionWriter writer(file);
  writeRows(writer, 3);
  writer.finish();
  EXPECT_EQ(readMotion(file).size(), 3U);
}

TEST(MotionWriter, AMissingFolderIsNamed) {
  const test::TemporaryFolder folder;
  try {
    MotionWriter writer(folder.path() / "missing" / "record.csv");
    FAIL() << "no error";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("missing/record.csv"));
    EXPECT_THAT(e.what(), HasSubstr("No such file or directory"));
  }
  EXPECT_THROW(MotionWriter{folder.path()}, FileError);
}

}  // namespace
}  // namespace nearfit::motion_recording_test
