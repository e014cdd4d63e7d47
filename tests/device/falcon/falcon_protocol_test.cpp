#include "device/falcon/falcon_protocol.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace nearfit::falcon::falcon_protocol_test {
namespace {

std::string textOf(const Command& command) {
  std::string text;
  for (const std::byte byte : encode(command))
    text += static_cast<char>(byte);
  return text;
}

/// The last report that the reader finds, if any.
std::optional<Report> take(FrameReader& reader, std::string_view text) {
  std::optional<Report> last;
  for (const char c : text) {
    if (const auto report = reader.take(static_cast<std::byte>(c))) last = report;
  }
  return last;
}

TEST(FalconProtocol, ARestingCommandIsAllAs) {
  EXPECT_EQ(textOf({}), "<AAAAAAAAAAAAAA>");
}

TEST(FalconProtocol, NumbersAreFourLettersLowestFirst) {
  // 0x1234 is E D C B; -1 is P P P P; -4096 is 0xf000.
  EXPECT_EQ(textOf({.torques = {0x1234, -1, -4096}}), "<EDCBPPPPAAAPAA>");
}

TEST(FalconProtocol, LightsAndHomingShareALetter) {
  EXPECT_EQ(textOf({.lights = kGreen}), "<AAAAAAAAAAAACA>");
  EXPECT_EQ(textOf({.lights = kBlue}), "<AAAAAAAAAAAAEA>");
  EXPECT_EQ(textOf({.lights = kRed, .isHoming = true}), "<AAAAAAAAAAAAJA>");
}

TEST(FalconProtocol, AReportIsReadLetterByLetter) {
  FrameReader reader;
  // Flags 'A' + 0x7a: all homed, buttons 2 and 4.
  const std::string frame = std::string("<EDCBPPPPAAAP") + static_cast<char>('A' + 0x7a) + "A>";
  const auto report = take(reader, frame);
  ASSERT_TRUE(report);
  EXPECT_EQ(*report, (Report{{0x1234, -1, -4096}, kAllHomed, 0xa}));
  EXPECT_EQ(reader.damaged(), 0U);
}

TEST(FalconProtocol, FramesAreFoundHoweverTheyAreCut) {
  const std::string frames = "AAA><BAAAAAAAAAAAAA><CAAAAAAAAAAAAA>";
  FrameReader reader;
  std::vector<int> found;
  for (const char c : frames) {
    if (const auto report = reader.take(static_cast<std::byte>(c))) found.push_back(report->encoders[0]);
  }
  EXPECT_EQ(found, (std::vector<int>{1, 2}));
  EXPECT_EQ(reader.damaged(), 0U) << "what came before the first frame began is nobody's fault";
}

TEST(FalconProtocol, DamagedFramesAreCountedAndTheNextIsRead) {
  for (const std::string damaged :
       {"<AAAA>", "<AAAAAAAAAAAAAAA", "<AAAAQAAAAAAAAA>", "<AA AAAAAAAAAAA>", "<AAAAAAAAAAAA0A>", "<AAAA"}) {
    FrameReader reader;
    EXPECT_FALSE(take(reader, damaged)) << damaged;
    const auto report = take(reader, "<DAAAAAAAAAAAAA>");
    ASSERT_TRUE(report) << damaged;
    EXPECT_EQ(report->encoders[0], 3);
    EXPECT_EQ(reader.damaged(), 1U) << damaged;
  }
}

}  // namespace
}  // namespace nearfit::falcon::falcon_protocol_test
