#include "device/hid/report_descriptor.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/usb/spacemouse_firmware.h"

namespace nearfit::report_descriptor_test {
namespace {

std::vector<std::byte> bytesOf(std::initializer_list<unsigned> values) {
  std::vector<std::byte> bytes;
  for (const unsigned value : values)
    bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

const HidField* fieldOf(const HidReports& reports, std::uint32_t usage) {
  const auto found = std::find_if(reports.fields.begin(), reports.fields.end(),
                                  [&](const HidField& field) { return field.usage == usage; });
  return found == reports.fields.end() ? nullptr : &*found;
}

TEST(ReportDescriptor, AxesOfASpaceNavigatorStandWhereItsReportsHaveThem) {
  const std::optional<HidReports> reports = parseReportDescriptor(test::spaceNavigatorDescriptor());
  ASSERT_TRUE(reports);
  EXPECT_TRUE(reports->hasNumbers);
  ASSERT_EQ(reports->applications.size(), 1U);
  EXPECT_EQ(reports->applications[0], hid_usage::kMultiAxisController);
  const HidField* z = fieldOf(*reports, hid_usage::kZ);
  ASSERT_NE(z, nullptr);
  EXPECT_EQ(z->reportId, 1);
  EXPECT_EQ(z->bitOffset, 8U + 32U) << "the number, then X and Y of 16 bits each";
  EXPECT_EQ(z->bitCount, 16U);
  EXPECT_EQ(z->logicalMinimum, -350);
  EXPECT_EQ(z->logicalMaximum, 350);
  const HidField* rx = fieldOf(*reports, hid_usage::kRx);
  ASSERT_NE(rx, nullptr);
  EXPECT_EQ(rx->reportId, 2);
  EXPECT_EQ(rx->bitOffset, 8U);
  const HidField* second = fieldOf(*reports, 0x90002);
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(second->reportId, 3);
  EXPECT_EQ(second->bitOffset, 9U);
  const HidField* led = fieldOf(*reports, 0x8004b);
  ASSERT_NE(led, nullptr);
  EXPECT_EQ(led->kind, HidReportKind::Output);
  EXPECT_EQ(led->reportId, 4);
}

TEST(ReportDescriptor, FieldsAreReadWithTheirSigns) {
  const HidField field{HidReportKind::Input, 1, hid_usage::kX, 8, 16, -350, 350, false};
  EXPECT_EQ(readField(bytesOf({1, 0x5e, 0x01}), field, true), 350);
  EXPECT_EQ(readField(bytesOf({1, 0xa2, 0xfe}), field, true), -350);
  EXPECT_EQ(readField(bytesOf({2, 0x5e, 0x01}), field, true), std::nullopt) << "another report";
  EXPECT_EQ(readField(bytesOf({1, 0x5e}), field, true), std::nullopt) << "too short";
  const HidField odd{HidReportKind::Input, 0, hid_usage::kX, 3, 5, 0, 31, false};
  EXPECT_EQ(readField(bytesOf({0b10101'010}), odd, false), 0b10101);
  const HidField negative{HidReportKind::Input, 0, hid_usage::kX, 3, 5, -16, 15, false};
  EXPECT_EQ(readField(bytesOf({0b10101'010}), negative, false), 0b10101 - 32);
}

TEST(ReportDescriptor, WhatIsWrittenIsRead) {
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> report(8, static_cast<std::byte>(random()));
    HidField field{HidReportKind::Output,
                   0,
                   1,
                   static_cast<std::uint32_t>(random() % 32),
                   static_cast<std::uint32_t>(1 + random() % 32),
                   -1,
                   1,
                   false};
    const auto value = static_cast<std::int32_t>(random());
    const std::int32_t kept =
        field.bitCount == 32
            ? value
            : static_cast<std::int32_t>(static_cast<std::uint32_t>(value) << (32 - field.bitCount)) >>
                  (32 - field.bitCount);
    writeField(report, field, value);
    EXPECT_EQ(readField(report, field, false), kept);
  }
}

TEST(ReportDescriptor, DamagedOnesAreRefused) {
  EXPECT_FALSE(parseReportDescriptor(bytesOf({0x05}))) << "an item without its data";
  EXPECT_FALSE(parseReportDescriptor(bytesOf({0xa1, 0x01}))) << "a collection that does not close";
  EXPECT_FALSE(parseReportDescriptor(bytesOf({0xc0}))) << "one that was never opened";
  EXPECT_FALSE(parseReportDescriptor(bytesOf({0xb4}))) << "nothing was pushed";
  EXPECT_FALSE(parseReportDescriptor(bytesOf({0xfe, 0x05, 0x00, 0x01}))) << "a long item that ends early";
  EXPECT_FALSE(parseReportDescriptor(bytesOf({0x85, 0x00}))) << "a report numbered 0";
  // Four thousand million values of 32 bits.
  EXPECT_FALSE(parseReportDescriptor(
      bytesOf({0x05, 0x01, 0x09, 0x30, 0x75, 0x20, 0x97, 0xff, 0xff, 0xff, 0xff, 0x81, 0x02})));
  EXPECT_FALSE(parseReportDescriptor(bytesOf({0x1b, 0x00, 0x00, 0x00, 0x00, 0x2b, 0xff, 0xff, 0xff, 0x7f})))
      << "two thousand million usages";
}

// A usage of four bytes of ones: counting up to it never ended, and filled the memory. Found by fuzzing.
TEST(ReportDescriptor, LargestUsageThereIsIsAnEnd) {
  const auto reports =
      parseReportDescriptor(bytesOf({0x0b, 0xff, 0xff, 0xff, 0xff, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02}));
  ASSERT_TRUE(reports);
  ASSERT_EQ(reports->fields.size(), 1U);
  EXPECT_EQ(reports->fields[0].usage, 0xffffffffU);
}

TEST(ReportDescriptor, EveryPrefixAndEveryDamagedByteEndsWell) {
  const std::vector<std::byte> whole = test::spaceNavigatorDescriptor();
  for (std::size_t size = 0; size < whole.size(); ++size)
    parseReportDescriptor(std::span(whole).first(size));
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::byte> damaged = whole;
    for (int n = 0; n < 3; ++n)
      damaged[random() % damaged.size()] = static_cast<std::byte>(random());
    if (const std::optional<HidReports> reports = parseReportDescriptor(damaged)) {
      EXPECT_LE(reports->fields.size(), kMaxHidFields);
      std::array<std::byte, 16> report{};
      for (const HidField& field : reports->fields)
        readField(report, field, reports->hasNumbers);
    }
  }
}

}  // namespace
}  // namespace nearfit::report_descriptor_test
