#include "device/polhem/polhem_protocol.h"

#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace nearfit::polhem::polhem_protocol_test {
namespace {

using testing::ElementsAre;

std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> result;
  for (const int value : values)
    result.push_back(static_cast<std::byte>(value));
  return result;
}

TEST(PolhemProtocol, ReportIsSevenLittleEndianNumbers) {
  const auto report =
      decode(bytes({0x01, 0x00, 0xff, 0xff, 0x34, 0x12, 0x00, 0x80, 0xff, 0x7f, 0x10, 0x27, 0x01, 0x00}));
  ASSERT_TRUE(report);
  EXPECT_THAT(report->encoders, ElementsAre(1, -1, 0x1234, -32768, 32767, 10000));
  EXPECT_TRUE(report->isButtonPressed);
}

TEST(PolhemProtocol, ATeensysPacketHoldsTheSameInItsFirstBytes) {
  std::vector<std::byte> packet = bytes({5, 0, 4, 0, 3, 0, 2, 0, 1, 0, 0, 0, 0, 0});
  packet.resize(kRawHidSize, std::byte{0xaa});
  const auto report = decode(packet);
  ASSERT_TRUE(report);
  EXPECT_THAT(report->encoders, ElementsAre(5, 4, 3, 2, 1, 0));
  EXPECT_FALSE(report->isButtonPressed);
}

TEST(PolhemProtocol, PacketsOfAnyOtherSizeAreRefused) {
  for (std::size_t size = 0; size <= 100; ++size) {
    const bool isRight = size == kPacketSize || size == kRawHidSize;
    EXPECT_EQ(decode(std::vector<std::byte>(size)).has_value(), isRight) << size;
  }
}

TEST(PolhemProtocol, CurrentsAreWrittenAsMilliampsAndTheRestIsZero) {
  const auto packet = encode({1, -1, 0x0123});
  EXPECT_THAT(std::vector<std::byte>(packet.begin(), packet.begin() + 8),
              testing::ElementsAreArray(bytes({0x01, 0x00, 0xff, 0xff, 0x23, 0x01, 0, 0})));
  for (std::size_t i = 6; i < packet.size(); ++i)
    EXPECT_EQ(packet[i], std::byte{0}) << i;
}

TEST(PolhemProtocol, CurrentsBeyondWhatTheAmplifiersBearAreCut) {
  // 2000 is 0x07d0, -2000 is 0xf830.
  const auto packet = encode({2001, std::numeric_limits<int>::min(), 2000});
  EXPECT_THAT(std::vector<std::byte>(packet.begin(), packet.begin() + 6),
              testing::ElementsAreArray(bytes({0xd0, 0x07, 0x30, 0xf8, 0xd0, 0x07})));
}

}  // namespace
}  // namespace nearfit::polhem::polhem_protocol_test
