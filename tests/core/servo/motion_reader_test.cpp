#include "core/servo/motion_reader.h"

#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/random_values.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::motion_reader_test {
namespace {

using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

MotionRow rowAt(double time, test::RandomValues& random) {
  MotionRow row;
  row.time = time;
  row.handle = random.pose().normalized();
  row.proxy = random.pose().normalized();
  row.wrench = {random.vector(3.0), random.vector(0.1)};
  row.lmds = 17;
  row.distance = random.flip(0.5) ? kInfinity : random.in(0.0, 1.0);
  row.queryTime = 12e-6;
  row.tickTime = 20e-6;
  row.lateBodies = 3;
  row.energyToHand = -2.5e-4;
  row.subSteps = 4;
  row.shortenedSteps = 5;
  row.refusedSteps = 6;
  row.constraints = 7;
  row.contacts = 8;
  row.overlapping = 9;
  row.proxyTime = 1.5e-6;
  row.lateness = 45e-6;
  row.wrenchTime = 2.5e-6;
  row.isBehind = row.isDistanceBound = true;
  row.isClamped = true;
  row.fault = ServoFault::WrenchNotFinite;
  if (random.flip(0.5)) row.grip = random.in(0.0, 0.5);
  return row;
}

class MotionReader : public ::testing::Test {
 protected:
  std::vector<MotionRow> read(const std::string& text) { return readMotion(folder_.write("felt.csv", text)); }
  /// The message of the error that reading gives.
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const FileError& error) {
      return error.what();
    }
    return "no error";
  }
  /// A recording of one row in which a column holds something else.
  static std::string with(const std::string& column, const std::string& value) {
    std::string header, row;
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"t_s", "0"},       {"handle_tx", "0"}, {"handle_ty", "0"}, {"handle_tz", "0"},
             {"handle_qw", "1"}, {"handle_qx", "0"}, {"handle_qy", "0"}, {"handle_qz", "0"},
             {"proxy_tx", "0"},  {"proxy_ty", "0"},  {"proxy_tz", "0"},  {"proxy_qw", "1"},
             {"proxy_qx", "0"},  {"proxy_qy", "0"},  {"proxy_qz", "0"},  {"force_x", "0"},
             {"force_y", "0"},   {"force_z", "0"},   {"torque_x", "0"},  {"torque_y", "0"},
             {"torque_z", "0"},  {"distance", "1"},  {"fault", "0"},     {"tick_us", "1"},
             {"lmds", "1"},      {"grip", "nan"}}) {
      header += (header.empty() ? "" : ",") + name;
      row += (row.empty() ? "" : ",") + (name == column ? value : text);
    }
    return header + "\n" + row + "\n";
  }

  test::TemporaryFolder folder_;
};

TEST_F(MotionReader, WhatIsWrittenReadsBackTheSame) {
  test::RandomValues random(3);
  std::vector<MotionRow> written;
  const auto file = folder_.path() / "felt.csv";
  MotionWriter writer(file);
  for (int i = 0; i < 2500; ++i) {
    written.push_back(rowAt(0.5 + 0.001 * i, random));
    writer.write(written.back());
  }
  writer.finish();
  std::vector<double> fractions;
  const auto read = readMotion(file, [&](double fraction) {
    fractions.push_back(fraction);
    return true;
  });
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    MotionRow expected = written[i];
    EXPECT_EQ(read[i].time, expected.time - 0.5) << "time begins with zero";
    EXPECT_LT(glm::distance(read[i].proxy.applyToPoint({1, 2, 3}), expected.proxy.applyToPoint({1, 2, 3})),
              1e-14);
    EXPECT_EQ(read[i].handle.translation, expected.handle.translation);
    // The rest as it is written.
    MotionRow again = read[i];
    again.time = expected.time;
    again.handle = expected.handle;
    again.proxy = expected.proxy;
    EXPECT_EQ(again.grip, expected.grip);
    EXPECT_EQ(formatMotionRow(again), formatMotionRow(expected));
  }
  ASSERT_EQ(fractions.size(), 2U);
  EXPECT_TRUE(fractions[0] > 0.0 && fractions[0] < fractions[1] && fractions[1] <= 1.0);
  EXPECT_THROW(readMotion(file, [](double) { return false; }), Cancelled);
}

// What a killed program leaves, or a disk that got full, ends anywhere.
TEST_F(MotionReader, AFileThatIsCutWithinARowGivesTheWholeRowsAndSaysSo) {
  test::RandomValues random(5);
  std::string text = std::string(motionHeader()) + "\n";
  for (int i = 0; i < 3; ++i)
    text += formatMotionRow(rowAt(0.001 * i, random)) + "\n";
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1, lastColumn = text.rfind(',');
  for (std::size_t end = last; end <= text.size(); ++end) {
    const Recording read = readRecording(folder_.write("felt.csv", text.substr(0, end)));
    // Of the last column, which only says how late the tick was, some digits may be missing.
    const bool isCut = end > last && end <= lastColumn + 1;
    EXPECT_EQ(read.isCut, isCut) << end;
    EXPECT_EQ(read.rows.size(), end == last || isCut ? 2U : 3U) << end;
  }
  EXPECT_THAT(refusal(text.substr(0, text.size() - 40) + "\n"), HasSubstr("felt.csv:4"))
      << "a row that ends is no row that was cut";
  EXPECT_THAT(refusal(text.substr(0, text.find('\n') + 20)), HasSubstr("felt.csv:2"));
}

TEST_F(MotionReader, OlderRecordingsLackColumnsAndLaterOnesMayHaveMore) {
  const auto rows = read(
      "x,force_z,t_s,handle_tx,handle_ty,handle_tz,handle_qw,handle_qx,handle_qy,handle_qz,"
      "proxy_tx,proxy_ty,proxy_tz,proxy_qw,proxy_qx,proxy_qy,proxy_qz,force_x,force_y,"
      "torque_x,torque_y,torque_z\n"
      "what,3,7,0,0,0,1,0,0,0,0.5,0,0,1,0,0,0,1,2,4,5,6\n");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].wrench.force, glm::dvec3(1, 2, 3));
  EXPECT_EQ(rows[0].wrench.torque, glm::dvec3(4, 5, 6));
  EXPECT_EQ(rows[0].proxy.translation.x, 0.5);
  EXPECT_EQ(rows[0].distance, kInfinity);
  EXPECT_EQ(rows[0].tickTime, 0.0);
  EXPECT_FALSE(rows[0].grip);
}

TEST_F(MotionReader, NothingThatAFileSaysIsTrusted) {
  EXPECT_EQ(read(with("", "")).size(), 1U) << "the row that the others are made of is right";
  for (const auto& [column, value] : std::vector<std::pair<std::string, std::string>>{{"t_s", "nan"},
                                                                                      {"t_s", "1e300"},
                                                                                      {"force_x", "inf"},
                                                                                      {"force_x", "1e300"},
                                                                                      {"distance", "nan"},
                                                                                      {"distance", "-1"},
                                                                                      {"lmds", "1.5"},
                                                                                      {"lmds", "-1"},
                                                                                      {"lmds", "1e30"},
                                                                                      {"fault", "99"},
                                                                                      {"tick_us", "-3"},
                                                                                      {"tick_us", "inf"},
                                                                                      {"grip", "inf"},
                                                                                      {"grip", "what"},
                                                                                      {"proxy_tx", "1e12"},
                                                                                      {"handle_qw", "0.5"},
                                                                                      {"torque_y", "what"},
                                                                                      {"torque_z", ""}}) {
    EXPECT_THAT(refusal(with(column, value)), HasSubstr("felt.csv:2")) << column << " " << value;
  }
  EXPECT_THAT(refusal(with("lmds", "1.5")), HasSubstr("\"1.5\" is not a valid lmds"));
  EXPECT_THAT(refusal("t_s,handle_tx\n0,0\n"), HasSubstr("felt.csv:1: there is no column handle_ty"));
  EXPECT_THAT(refusal(""), HasSubstr("it is empty"));
  const std::string header = std::string(motionHeader()) + "\n";
  EXPECT_THAT(refusal(header), HasSubstr("it has no rows"));
  EXPECT_THAT(refusal(header + "0,1,2\n"), HasSubstr("felt.csv:2: it ends before column"));
  test::RandomValues random(1);
  EXPECT_THAT(refusal(header + formatMotionRow(rowAt(1.0, random)) + "\n" +
                      formatMotionRow(rowAt(0.5, random)) + "\n"),
              HasSubstr("felt.csv:3: its time is earlier than that of the row before"));
  EXPECT_THROW(readMotion(folder_.path() / "missing.csv"), FileError);
}

}  // namespace
}  // namespace nearfit::motion_reader_test
