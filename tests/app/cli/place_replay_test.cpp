#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/app/cli/place_fixture.h"

namespace nearfit::test::place_replay_test {
namespace {

using ::testing::HasSubstr;

class PlaceReplay : public PlaceFixture {
 protected:
  PlaceReplay() {
    const ProcessResult made = placeCone({"--fast", "--record", "felt.csv"});
    EXPECT_EQ(made.exitCode, 0) << made.err;
  }
  ProcessResult replay(std::vector<std::string> more) const {
    more.insert(more.begin(), {"--part", "Cone", "--device", "replay:felt.csv"});
    return place(more);
  }
};

TEST_F(PlaceReplay, ARecordedHandLeadsThePartAgainFromWhereItBeganToWhereItEnded) {
  const ProcessResult result = replay({"--record", "again.csv", "--export", "end.json", "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto device = nlohmann::json::parse(result.out)["device"];
  EXPECT_EQ(device["reports"], kTicks);
  EXPECT_EQ(device["armed"], false);
  const Record record(file("again.csv"));
  ASSERT_GT(record.rows(), 1U);
  EXPECT_NEAR(record["handle_tz"].front(), heightAt(0), 1e-12);
  EXPECT_NEAR(record["handle_tz"].back(), heightAt(kTicks - 1), 1e-12);
  double last = heightAt(0);
  for (std::size_t i = 0; i < record.rows(); ++i) {
    const double height = record["handle_tz"][i];
    EXPECT_LE(height, last + 1e-12) << "in the order of the recording";
    last = height;
    // What the springs say at most: it fades in.
    EXPECT_LE(record["force_z"][i], 50.0 * std::max(0.0, 0.1 - height) + 1e-9);
  }
  const auto end = nlohmann::json::parse(readBytes(file("end.json")));
  EXPECT_THAT(end.dump(), HasSubstr("Cone"));
}

TEST_F(PlaceReplay, WhatWasMappedOnceIsNotMappedAgain) {
  const ProcessResult result = replay({"--scale", "2", "--record", "again.csv"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NEAR(Record(file("again.csv"))["handle_tz"].back(), heightAt(kTicks - 1), 1e-12);
}

TEST_F(PlaceReplay, ARecordingIsNotOverwrittenByItsOwnReplay) {
  const std::string before = readBytes(file("felt.csv"));
  const ProcessResult result = replay({"--record", "felt.csv"});
  EXPECT_NE(result.exitCode, 0);
  EXPECT_EQ(readBytes(file("felt.csv")), before);
}

TEST_F(PlaceReplay, APipeIsRefused) {
  ASSERT_EQ(::mkfifo(file("pipe.csv").c_str(), 0600), 0);
  const ProcessResult result = place({"--part", "Cone", "--device", "replay:pipe.csv"});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_THAT(result.err, HasSubstr("pipe.csv: it is not a regular file"));
}

TEST_F(PlaceReplay, WhatIsNoRecordingIsRefusedWithItsPlace) {
  const ProcessResult path = place({"--part", "Cone", "--device", "replay:path.csv"});
  EXPECT_EQ(path.exitCode, 1);
  EXPECT_THAT(path.err, HasSubstr("path.csv:2: there is no column t_s"));
  EXPECT_EQ(linesOf(path.err).size(), 1U);
  const ProcessResult none = place({"--part", "Cone", "--device", "replay:none.csv"});
  EXPECT_EQ(none.exitCode, 1);
  EXPECT_THAT(none.err, HasSubstr("none.csv"));
}

}  // namespace
}  // namespace nearfit::test::place_replay_test
