#include "device/registry/device_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "tests/usb/emulated_bus.h"
#include "tests/usb/openhap_emulator.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::device_list_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// A SpaceNavigator as far as a look from outside goes; the system's driver holds it.
test::EmulatedDescription navigator() {
  test::EmulatedDescription description;
  description.vendor = 0x046d;
  description.product = 0xc626;
  description.productName = "SpaceNavigator";
  description.interfaces = {{.classCode = 3, .endpoints = {{.address = 0x81}}, .kernelDriver = "usbhid"}};
  return description;
}

class DeviceList : public testing::Test {
 protected:
  std::vector<DeviceListing> list() {
    const UsbBus usb;
    std::vector<std::string> problems;
    std::vector<DeviceListing> devices = listDevices(usb, {}, problems);
    EXPECT_THAT(problems, IsEmpty());
    return devices;
  }
  static DeviceProblem causeOf(const std::vector<DeviceListing>& devices, std::string_view wanted) {
    try {
      chooseDevice(devices, wanted);
    } catch (const DeviceError& error) {
      return error.cause();
    }
    ADD_FAILURE() << "it was chosen";
    return {};
  }

  test::EmulatedBus bus;
  test::OpenHapEmulator openhap;
  std::shared_ptr<test::EmulatedDevice> mouse = std::make_shared<test::EmulatedDevice>(navigator());
};

TEST_F(DeviceList, KnownDevicesAreListedByTheirNamesAndOthersAreNot) {
  EXPECT_THAT(list(), IsEmpty());
  bus.plug(test::plainDevice(), 1);
  bus.plug(mouse, 3);
  const std::vector<DeviceListing> devices = list();
  ASSERT_EQ(devices.size(), 1U);
  EXPECT_EQ(devices[0].driver, "spacemouse");
  EXPECT_EQ(devices[0].name, "SpaceNavigator");
  EXPECT_EQ(devices[0].id, "046d:c626");
  EXPECT_EQ(devices[0].place, "1-3");
  EXPECT_EQ(devices[0].kernelDriver, "usbhid");
  EXPECT_TRUE(devices[0].isUsable());
}

TEST_F(DeviceList, LookingTakesNothingFromWhoeverUsesADevice) {
  bus.plug(mouse);
  list();
  EXPECT_TRUE(mouse->isKernelDriverBound(0));
  EXPECT_FALSE(mouse->isOpen());
}

TEST_F(DeviceList, ADeviceThatTheUserMayNotOpenSaysSo) {
  bus.plug(mouse);
  mouse->denyPermission(true);
  const std::vector<DeviceListing> devices = list();
  ASSERT_EQ(devices.size(), 1U);
  EXPECT_EQ(devices[0].problem, DeviceProblem::NoPermission);
  EXPECT_THAT(devices[0].reason, HasSubstr("permission"));
  EXPECT_EQ(causeOf(devices, "spacemouse"), DeviceProblem::NoPermission);
  mouse->denyPermission(false);
  EXPECT_TRUE(list().at(0).isUsable());
}

TEST_F(DeviceList, ADeviceThatAnotherProgramHoldsIsBusy) {
  bus.plug(openhap.device());
  EXPECT_TRUE(list().at(0).isUsable());
  openhap.device()->claimElsewhere(0, true);
  const std::vector<DeviceListing> devices = list();
  EXPECT_EQ(devices.at(0).problem, DeviceProblem::Busy);
  EXPECT_THAT(devices.at(0).reason, HasSubstr("another program"));
  EXPECT_EQ(causeOf(devices, ""), DeviceProblem::Busy);
}

TEST_F(DeviceList, ADeviceWithoutADriverSaysWhy) {
  test::EmulatedDescription hydra;
  hydra.vendor = 0x1532;
  hydra.product = 0x0300;
  hydra.productName = "Hydra";
  hydra.interfaces = {{.classCode = 3, .endpoints = {{.address = 0x81}}}};
  bus.plug(std::make_shared<test::EmulatedDevice>(hydra));
  const std::vector<DeviceListing> devices = list();
  ASSERT_EQ(devices.size(), 1U);
  EXPECT_EQ(devices[0].driver, "none");
  EXPECT_EQ(devices[0].problem, DeviceProblem::Unsupported);
  EXPECT_FALSE(devices[0].reason.empty());
}

TEST_F(DeviceList, ADeviceIsChosenByWhateverNamesIt) {
  bus.plug(mouse, 2);
  bus.plug(openhap.device(), 4);
  const std::vector<DeviceListing> devices = list();
  ASSERT_EQ(devices.size(), 2U);
  for (const std::string name : {"openhap", "OpenHap", "1-4"})
    EXPECT_EQ(chooseDevice(devices, name).driver, "openhap") << name;
  EXPECT_EQ(chooseDevice(devices, devices[1].usb.node()).driver, "openhap");
  EXPECT_EQ(chooseDevice(devices, devices[1].id).driver, "openhap");
  for (const std::string name : {"spacemouse", "navigator", "046D:C626", ""})
    EXPECT_EQ(chooseDevice(devices, name).driver, "spacemouse") << name;
  // The first that can be used, where any will do.
  mouse->denyPermission(true);
  EXPECT_EQ(chooseDevice(list(), "").driver, "openhap");
}

TEST_F(DeviceList, WhatIsNotThereIsAnsweredWithWhatIs) {
  EXPECT_EQ(causeOf(list(), ""), DeviceProblem::Gone);
  bus.plug(mouse, 2);
  try {
    chooseDevice(list(), "falcon");
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.cause(), DeviceProblem::Gone);
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("\"falcon\""), HasSubstr("SpaceNavigator (spacemouse at 1-2)")));
  }
}

TEST_F(DeviceList, ADeviceThatIsPluggedInAgainIsAnotherOne) {
  bus.plug(mouse, 2);
  const DeviceListing before = list().at(0);
  EXPECT_TRUE(before.isSamePlugging(list().at(0)));
  bus.unplug(*mouse);
  EXPECT_THAT(list(), IsEmpty());
  bus.plug(mouse, 2);
  EXPECT_FALSE(before.isSamePlugging(list().at(0)));
}

}  // namespace
}  // namespace nearfit::device_list_test
