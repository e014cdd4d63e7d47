#include "device/spacemouse/spacemouse_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/usb/spacemouse_firmware.h"

namespace nearfit::spacemouse_reader_test {
namespace {

using test::SpaceMouseFirmware;
using testing::DoubleEq;
using testing::ElementsAre;

SpaceMouseState readAll(const SpaceMouseReader& reader, const SpaceMouseFirmware& device) {
  SpaceMouseState state;
  for (const std::vector<std::byte>& report : device.reports())
    EXPECT_TRUE(reader.read(report, state));
  return state;
}

class SpaceMouseModels : public testing::TestWithParam<SpaceMouseFirmware::Model> {};

TEST_P(SpaceMouseModels, FramesAreTurnedToOneWhoSitsBeforeIt) {
  SpaceMouseFirmware device(GetParam());
  // Right, away (y is towards the user), up (z is down); and about them.
  device.counts = {350, -175, -70, 35, 350, -350};
  device.buttons = 0b10;
  for (const SpaceMouseReader& reader :
       {*SpaceMouseReader::fromDescriptor(device.descriptor()), SpaceMouseReader::withKnownLayout()}) {
    const SpaceMouseState state = readAll(reader, device);
    EXPECT_THAT(state.axes, ElementsAre(DoubleEq(1.0), DoubleEq(0.5), DoubleEq(0.2), DoubleEq(0.1),
                                        DoubleEq(-1.0), DoubleEq(1.0)));
    EXPECT_EQ(state.buttons, 0b10U);
  }
}

TEST_P(SpaceMouseModels, OvershootIsFullDeflection) {
  SpaceMouseFirmware device(GetParam());
  device.counts = {32767, 0, 0, -32768, 0, 0};
  const SpaceMouseState state = readAll(*SpaceMouseReader::fromDescriptor(device.descriptor()), device);
  EXPECT_EQ(state.axes[0], 1.0);
  EXPECT_EQ(state.axes[3], -1.0);
}

TEST_P(SpaceMouseModels, LightIsItsOutputReport) {
  const SpaceMouseFirmware device(GetParam());
  const auto report = SpaceMouseReader::fromDescriptor(device.descriptor())->ledReport(true);
  ASSERT_TRUE(report);
  ASSERT_EQ(report->size, 2U);
  EXPECT_EQ(report->bytes[0], std::byte{4});
  EXPECT_EQ(report->bytes[1], std::byte{1});
}

INSTANTIATE_TEST_SUITE_P(All, SpaceMouseModels,
                         testing::Values(SpaceMouseFirmware::Model::Navigator,
                                         SpaceMouseFirmware::Model::Pro));

TEST(SpaceMouseReader, ShortAndUnknownReportsChangeNothing) {
  const SpaceMouseReader reader = *SpaceMouseReader::fromDescriptor(test::spaceNavigatorDescriptor());
  SpaceMouseState state;
  state.axes[0] = 0.25;
  const std::array<std::byte, 3> unknown = {std::byte{9}, std::byte{1}, std::byte{1}};
  EXPECT_FALSE(reader.read(unknown, state));
  EXPECT_FALSE(reader.read({}, state));
  EXPECT_FALSE(reader.read(std::span(unknown).first(1), state));
  EXPECT_EQ(state.axes[0], 0.25);
}

TEST(SpaceMouseReader, DescriptorsWithoutSixAxesAreNone) {
  std::vector<std::byte> keyboard = {std::byte{0x05}, std::byte{0x01}, std::byte{0x09}, std::byte{0x06},
                                     std::byte{0xa1}, std::byte{0x01}, std::byte{0xc0}};
  EXPECT_FALSE(SpaceMouseReader::fromDescriptor(keyboard));
  EXPECT_FALSE(SpaceMouseReader::fromDescriptor({}));
}

}  // namespace
}  // namespace nearfit::spacemouse_reader_test
