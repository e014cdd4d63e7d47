#include "device/registry/device_registry.h"

#include <fstream>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::device_registry_test {
namespace {

using testing::HasSubstr;

/// With one interface that has an endpoint of 64 bytes each way.
UsbDescription device(std::uint16_t vendor, std::uint16_t product, std::uint8_t classCode = 0xff,
                      std::uint8_t subclass = 0, std::uint8_t protocol = 0) {
  UsbDescription description;
  description.vendor = vendor;
  description.product = product;
  description.interfaces = {{.classCode = classCode,
                             .subclass = subclass,
                             .protocol = protocol,
                             .endpoints = {{0x81, UsbTransferType::Interrupt, 64, 1e-3},
                                           {0x02, UsbTransferType::Interrupt, 64, 1e-3}}}};
  return description;
}

DeviceDriver driverOf(const UsbDescription& description) {
  const auto match = recognise(description);
  EXPECT_TRUE(match) << description.id();
  return match ? match->driver : DeviceDriver::None;
}

TEST(DeviceRegistry, EachDriverTakesItsOwn) {
  EXPECT_EQ(driverOf(device(0x1209, 0x0001, 0xff, 0x48, 1)), DeviceDriver::OpenHap);
  EXPECT_EQ(driverOf(device(0x1234, 0x0006, 3)), DeviceDriver::Polhem);
  EXPECT_EQ(driverOf(device(0x16c0, 0x0486, 3)), DeviceDriver::Polhem);
  EXPECT_EQ(driverOf(device(0x0403, 0xcb48)), DeviceDriver::Falcon);
  EXPECT_EQ(driverOf(device(0x256f, 0xc635, 3)), DeviceDriver::SpaceMouse);
  EXPECT_EQ(driverOf(device(0x046d, 0xc626, 3)), DeviceDriver::SpaceMouse);
}

TEST(DeviceRegistry, DevicesWithClosedProtocolsAreKnownAndNotUsable) {
  for (const auto& [vendor, product] : {std::pair{0x1451, 0x0402}, {0x2988, 0x0302}, {0x0301, 0x2988}}) {
    const auto match =
        recognise(device(static_cast<std::uint16_t>(vendor), static_cast<std::uint16_t>(product)));
    ASSERT_TRUE(match);
    EXPECT_FALSE(match->isUsable());
    EXPECT_THAT(match->needs, HasSubstr("its maker's software"));
  }
  const auto hydra = recognise(device(0x1532, 0x0300));
  ASSERT_TRUE(hydra);
  EXPECT_FALSE(hydra->isUsable());
  EXPECT_THAT(hydra->needs, HasSubstr("no driver"));
}

TEST(DeviceRegistry, DevicesThatHaveNothingToDoWithTouchAreNotKnown) {
  EXPECT_FALSE(recognise(device(0x046d, 0xc077, 3))) << "a mouse of Logitech's";
  EXPECT_FALSE(recognise(device(0x0403, 0x6001))) << "a serial adapter with a Falcon's chip";
  EXPECT_FALSE(recognise(device(0x1532, 0x0016, 3))) << "a mouse of Razer's";
  EXPECT_FALSE(recognise(device(0x1209, 0x0001, 0xff, 0x49)));
}

TEST(DeviceRegistry, OpenHapOfAnotherVersionIsKnownAndNotUsable) {
  for (const int version : {0, 2}) {
    const UsbDescription other = device(0x1209, 1, 0xff, 0x48, static_cast<std::uint8_t>(version));
    const auto match = recognise(other);
    ASSERT_TRUE(match);
    EXPECT_FALSE(match->isUsable());
    EXPECT_EQ(match->needs, "it speaks version " + std::to_string(version) +
                                " of OpenHap, but this program speaks version 1");
    EXPECT_THAT(match->remedy, HasSubstr("newer Nearfit or newer firmware"));
    EXPECT_THROW(makeDevice(other, {}), DeviceError);
  }
}

TEST(DeviceRegistry, OpenHapOfOurVersionIsFoundBesideAnother) {
  UsbDescription both = device(0x1209, 1, 0xff, 0x48, 2);
  both.interfaces.push_back(device(0x1209, 1, 0xff, 0x48, 1).interfaces[0]);
  EXPECT_EQ(driverOf(both), DeviceDriver::OpenHap);
}

TEST(DeviceRegistry, OrdinaryMiceOfTheMakerOfSpaceMiceAreNeverTaken) {
  for (const int product : {0xc650, 0xc651, 0xc654, 0xc655, 0xc656, 0xc657, 0xc658}) {
    const UsbDescription cadMouse = device(0x256f, static_cast<std::uint16_t>(product), 3);
    const auto match = recognise(cadMouse);
    ASSERT_TRUE(match) << std::hex << product;
    EXPECT_FALSE(match->isUsable());
    EXPECT_THAT(match->needs, HasSubstr("ordinary mouse"));
    EXPECT_THROW(makeDevice(cadMouse, {}), DeviceError);
  }
  // One of a number that nobody knows yet: it says by its interface that it is a mouse, or a keyboard.
  for (const int protocol : {1, 2}) {
    const auto match = recognise(device(0x256f, 0xc6ff, 3, 1, static_cast<std::uint8_t>(protocol)));
    ASSERT_TRUE(match);
    EXPECT_FALSE(match->isUsable());
    EXPECT_THAT(match->needs, HasSubstr("six axes"));
  }
  EXPECT_EQ(driverOf(device(0x256f, 0xc6ff, 3)), DeviceDriver::SpaceMouse) << "a model to come";
}

TEST(DeviceRegistry, HaplysDevicesAreKnownByTheirNames) {
  for (const char* name : {"ZEPHYR Haply USB Transceiver", "Haply Robotics Inverse3"}) {
    const auto match = recogniseByName(name);
    ASSERT_TRUE(match) << name;
    EXPECT_FALSE(match->isUsable());
    EXPECT_THAT(match->needs, HasSubstr("its maker's software"));
  }
  EXPECT_FALSE(recogniseByName("Logitech USB Optical Mouse"));
  EXPECT_FALSE(recogniseByName(""));
  // Inside an Inverse3 is a Teensy that calls itself nothing else.
  const auto teensy = recognise(device(0x16c0, 0x0483, 2));
  ASSERT_TRUE(teensy);
  EXPECT_FALSE(teensy->isUsable());
  EXPECT_THAT(teensy->needs, HasSubstr("if it is in a Haply Inverse3"));
}

TEST(DeviceRegistry, ATeensyIsNamedWithDoubt) {
  EXPECT_THAT(recognise(device(0x16c0, 0x0486, 3))->name, HasSubstr("Teensy, if"));
  EXPECT_EQ(recognise(device(0x1234, 0x0006, 3))->name, "WoodenHaptics or Polhem");
}

TEST(DeviceRegistry, DriversAreMadeWithoutOpeningAnything) {
  for (const UsbDescription& each : {device(0x1209, 1, 0xff, 0x48, 1), device(0x1234, 6, 3),
                                     device(0x0403, 0xcb48), device(0x256f, 0xc635, 3)}) {
    const auto made = makeDevice(each, {});
    ASSERT_TRUE(made) << each.id();
    EXPECT_EQ(made->state(), DeviceState::Present);
    made->stop();
  }
}

TEST(DeviceRegistry, ForceArmsTellTheirLimits) {
  const DeviceInfo falcon = makeDevice(device(0x0403, 0xcb48), {})->info();
  EXPECT_EQ(falcon.forceAxes, 3);
  EXPECT_EQ(falcon.limits.maxForce, 9.0);
  EXPECT_EQ(falcon.limits.maxTorque, 0.0);
  EXPECT_GT(falcon.reportPeriod, 0.0);
  const DeviceInfo polhem = makeDevice(device(0x1234, 6, 3), {})->info();
  EXPECT_EQ(polhem.forceAxes, 3);
  EXPECT_EQ(polhem.limits.maxForce, 5.0);
  EXPECT_THAT(polhem.name, HasSubstr("WoodenHaptics"));
}

TEST(DeviceRegistry, ACalibrationFileThatIsWrongIsRefusedBeforeOpening) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(makeDevice(device(0x1234, 6, 3),
                          {.falconFirmware = {}, .polhemCalibration = folder.write("c.json", "{}")}),
               FileError);
}

TEST(DeviceRegistry, WhatCannotBeUsedIsNotMadeAndToldWhy) {
  try {
    makeDevice(device(0x1451, 0x0402), {});
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.cause(), DeviceProblem::Unsupported);
    EXPECT_THAT(error.where(), HasSubstr("Force Dimension"));
    EXPECT_THAT(error.problem(), HasSubstr("its maker's software"));
  }
  EXPECT_THROW(makeDevice(device(0x046d, 0xc077, 3), {}), DeviceError);
}

/// The ids that a rule lets users open.
bool isAllowed(const std::string& rules, std::uint16_t vendor, std::uint16_t product) {
  static const std::regex kRule(
      R"re(ATTR\{idVendor\}=="([0-9a-f]{4})",(?: ATTR\{idProduct\}=="([0-9a-f|]+)",)? TAG\+="uaccess")re");
  char ids[2][8];
  std::snprintf(ids[0], sizeof ids[0], "%04x", vendor);
  std::snprintf(ids[1], sizeof ids[1], "%04x", product);
  for (std::sregex_iterator each(rules.begin(), rules.end(), kRule), end; each != end; ++each) {
    if ((*each)[1] == ids[0] && (!(*each)[2].matched || (*each)[2].str().find(ids[1]) != std::string::npos))
      return true;
  }
  return false;
}

TEST(UdevRules, LetUsersOpenEveryDeviceThatHasADriver) {
  const std::string rules = test::readBytes(test::sourceFolder() / "resources/udev/70-nearfit.rules");
  for (const auto& [vendor, product] : {std::pair{0x1234, 0x0006},
                                        {0x16c0, 0x0486},
                                        {0x0403, 0xcb48},
                                        {0x256f, 0xc635},
                                        {0x046d, 0xc626},
                                        {0x046d, 0xc603},
                                        {0x046d, 0xc62b}}) {
    EXPECT_TRUE(isAllowed(rules, static_cast<std::uint16_t>(vendor), static_cast<std::uint16_t>(product)))
        << std::hex << vendor << ':' << product;
  }
  EXPECT_FALSE(isAllowed(rules, 0x046d, 0xc077)) << "other mice are not ours to open";
  EXPECT_FALSE(isAllowed(rules, 0x0403, 0x6001));
  EXPECT_THAT(rules, HasSubstr("ID_USB_INTERFACES")) << "OpenHap goes by its interface";
}

}  // namespace
}  // namespace nearfit::device_registry_test
