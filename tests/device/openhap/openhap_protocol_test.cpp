#include "device/openhap/openhap_protocol.h"

#include <limits>
#include <random>
#include <string_view>

#include <gtest/gtest.h>

namespace nearfit::openhap::openhap_protocol_test {
namespace {

PoseReport someReport() {
  PoseReport report;
  report.status = kHomed | kArmed;
  report.sequence = 0xfffe;
  report.microseconds = 0x80000001U;
  report.position = {0.125F, -0.25F, 0.5F};
  report.rotation = {0.5F, -0.5F, 0.5F, -0.5F};
  report.velocity = {1.0F, 2.0F, -3.0F};
  report.angularVelocity = {-4.0F, 5.0F, 6.0F};
  report.buttons = 0x8001;
  return report;
}

template <std::size_t n>
void seal(std::array<std::byte, n>& bytes) {
  const std::uint16_t crc = crc16(std::span(bytes).first(n - 2));
  bytes[n - 2] = static_cast<std::byte>(crc & 0xff);
  bytes[n - 1] = static_cast<std::byte>(crc >> 8);
}

TEST(OpenHapProtocol, ChecksumIsTheOneOfTheDocument) {
  const std::string_view text = "123456789";
  EXPECT_EQ(crc16(std::as_bytes(std::span(text))), 0x29b1);
  EXPECT_EQ(crc16({}), 0xffff);
}

TEST(OpenHapProtocol, PoseReportHasItsBytesWhereTheDocumentSays) {
  const auto bytes = encode(someReport());
  const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(bytes[i]); };
  EXPECT_EQ(at(0), 1U);
  EXPECT_EQ(at(1), 17U);
  EXPECT_EQ(at(2), 0xfeU);
  EXPECT_EQ(at(3), 0xffU);
  EXPECT_EQ(at(4), 1U);
  EXPECT_EQ(at(7), 0x80U);
  // 0.125 is 0x3e000000, little-endian.
  EXPECT_EQ(at(8), 0U);
  EXPECT_EQ(at(11), 0x3eU);
  EXPECT_EQ(at(60), 1U);
  EXPECT_EQ(at(61), 0x80U);
}

TEST(OpenHapProtocol, ReportsComeBackAsTheyWere) {
  PoseReport pose;
  EXPECT_EQ(decode(encode(someReport()), pose), Reject::None);
  EXPECT_EQ(pose, someReport());
  WrenchReport wrench{kForcesOn, 7, {1.0F, -2.0F, 3.0F}, {0.1F, 0.2F, -0.3F}, 20}, readBack;
  EXPECT_EQ(decode(encode(wrench), readBack), Reject::None);
  EXPECT_EQ(readBack, wrench);
  Capabilities capabilities;
  capabilities.hasDeadMan = true;
  capabilities.maxForce = 12.0F;
  capabilities.workspace = {0.1F, 0.2F, 0.3F};
  Capabilities back;
  EXPECT_EQ(decode(encode(capabilities), back), Reject::None);
  EXPECT_EQ(back, capabilities);
}

TEST(OpenHapProtocol, EachFlippedBitIsSeen) {
  const auto whole = encode(someReport());
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    auto damaged = whole;
    damaged[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    PoseReport report;
    EXPECT_NE(decode(damaged, report), Reject::None) << bit;
    EXPECT_EQ(report, PoseReport{}) << "left as it was";
  }
}

TEST(OpenHapProtocol, OtherSizesAndKindsAreRefused) {
  const auto pose = encode(someReport());
  PoseReport report;
  for (std::size_t size = 0; size < pose.size(); ++size)
    EXPECT_EQ(decode(std::span(pose).first(size), report), Reject::Size);
  std::array<std::byte, kPoseSize> other = pose;
  other[0] = std::byte{2};
  seal(other);
  EXPECT_EQ(decode(other, report), Reject::Kind);
}

TEST(OpenHapProtocol, NumbersThatAreNoneAreRefusedThoughTheChecksumIsRight) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    PoseReport report = someReport();
    report.velocity[1] = bad;
    PoseReport out;
    EXPECT_EQ(decode(encode(report), out), Reject::NotFinite);
    WrenchReport wrench;
    wrench.torque[2] = bad;
    EXPECT_EQ(decode(encode(wrench), wrench), Reject::NotFinite);
  }
  PoseReport report = someReport(), out;
  report.rotation = {0.0F, 0.0F, 0.0F, 0.0F};
  EXPECT_EQ(decode(encode(report), out), Reject::NotUnit);
  report = someReport();
  report.position[0] = 1e30F;
  EXPECT_EQ(decode(encode(report), out), Reject::OutOfRange);
}

TEST(OpenHapProtocol, CapabilitiesThatMakeNoSenseAreRefused) {
  Capabilities out;
  Capabilities is;
  is.major = 2;
  EXPECT_EQ(decode(encode(is), out), Reject::Version);
  is = {};
  is.rate = 0;
  EXPECT_EQ(decode(encode(is), out), Reject::OutOfRange);
  is = {};
  is.damping = -1.0F;
  EXPECT_EQ(decode(encode(is), out), Reject::OutOfRange);
}

TEST(OpenHapProtocol, RandomBytesWithRightChecksumsEndWell) {
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {
    std::array<std::byte, kPoseSize> bytes{};
    for (std::byte& byte : bytes)
      byte = static_cast<std::byte>(random());
    bytes[0] = std::byte{1};
    seal(bytes);
    PoseReport report;
    if (decode(bytes, report) != Reject::None) continue;
    for (const float part : report.position)
      EXPECT_TRUE(std::isfinite(part));
  }
}

}  // namespace
}  // namespace nearfit::openhap::openhap_protocol_test
