#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "device/registry/device_list.h"
#include "device/spacemouse/spacemouse_device.h"
#include "tests/usb/emulated_bus.h"
#include "tests/usb/report_stream.h"
#include "tests/usb/spacemouse_firmware.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::spacemouse_interfaces_test {
namespace {

using testing::HasSubstr;
using Model = test::SpaceMouseFirmware::Model;

/// Generic desktop, mouse: X and Y, relative, 8 bits each.
test::Bytes mouseDescriptor() {
  test::Bytes bytes;
  for (const unsigned value : {0x05U, 0x01U, 0x09U, 0x02U, 0xa1U, 0x01U, 0x09U, 0x30U, 0x09U, 0x31U, 0x15U,
                               0x81U, 0x25U, 0x7fU, 0x75U, 0x08U, 0x95U, 0x02U, 0x81U, 0x06U, 0xc0U})
    bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

test::EmulatedInterface hid(std::uint8_t endpoint, test::Bytes descriptor, std::uint8_t bootProtocol = 0) {
  test::EmulatedInterface face;
  face.classCode = 3;
  face.subclass = bootProtocol == 0 ? 0 : 1;
  face.protocol = bootProtocol;
  face.endpoints = {{.address = endpoint}};
  face.reportDescriptor = std::move(descriptor);
  face.kernelDriver = "usbhid";
  return face;
}

/// Devices of 3Dconnexion with interfaces of all kinds.
class SpaceMouseInterfaces : public testing::Test {
 protected:
  void plug(std::uint16_t product, std::vector<test::EmulatedInterface> interfaces) {
    test::EmulatedDescription description;
    description.vendor = 0x256f;
    description.product = product;
    description.productName = "From 3Dconnexion";
    description.interfaces = std::move(interfaces);
    device = std::make_shared<test::EmulatedDevice>(description);
    bus.plug(device, 2);
  }
  static UsbDescription seen() { return UsbBus().list().at(0); }
  static DeviceListing listed() {
    std::vector<std::string> problems;
    return listDevices(UsbBus(), {}, problems).at(0);
  }
  static std::optional<DeviceProblem> problemOfStart(SpaceMouseDevice& mouse) {
    try {
      mouse.start({});
    } catch (const DeviceError& error) {
      return error.cause();
    }
    return std::nullopt;
  }

  test::EmulatedBus bus;
  std::shared_ptr<test::EmulatedDevice> device;
};

TEST_F(SpaceMouseInterfaces, TheAxesAreFoundOnWhicheverInterfaceTheyAre) {
  test::SpaceMouseFirmware firmware(Model::Pro);
  plug(0xc652,
       {hid(0x81, mouseDescriptor(), 2), hid(0x82, mouseDescriptor()), hid(0x83, firmware.descriptor())});
  EXPECT_TRUE(listed().isUsable());
  SpaceMouseDevice mouse(seen());
  mouse.start({});
  EXPECT_TRUE(device->isKernelDriverBound(0)) << "the mouse is the desktop's";
  EXPECT_TRUE(device->isKernelDriverBound(1));
  EXPECT_FALSE(device->isKernelDriverBound(2));
  firmware.counts = {350, 0, 0, 0, 0, 0};
  device->send(0x83, firmware.reports().at(0));
  EXPECT_TRUE(test::eventually([&] { return mouse.newest().axes[0] == 1.0; }));
  mouse.stop();
  EXPECT_TRUE(device->isKernelDriverBound(2));
}

TEST_F(SpaceMouseInterfaces, EachInterfaceIsAskedWhereTheSystemDoesNotTell) {
  test::SpaceMouseFirmware firmware(Model::Navigator);
  std::vector<test::EmulatedInterface> faces = {hid(0x81, mouseDescriptor()),
                                                hid(0x82, firmware.descriptor())};
  for (test::EmulatedInterface& face : faces)
    face.kernelDriver.clear();
  plug(0xc6ff, faces);
  SpaceMouseDevice mouse(seen());
  mouse.start({});
  firmware.counts = {0, -350, 0, 0, 0, 0};
  device->send(0x82, firmware.reports().at(0));
  EXPECT_TRUE(test::eventually([&] { return mouse.newest().axes[1] == 1.0; }));
}

TEST_F(SpaceMouseInterfaces, WhatSaysThatItLacksAxesIsRefusedInPlainWordsAndLeftAlone) {
  plug(0xc62c, {hid(0x81, mouseDescriptor())});
  const DeviceListing listing = listed();
  EXPECT_EQ(listing.problem, DeviceProblem::Unsupported);
  EXPECT_THAT(listing.reason, HasSubstr("six axes"));
  EXPECT_TRUE(device->isKernelDriverBound(0));
  EXPECT_FALSE(device->isOpen());
}

TEST_F(SpaceMouseInterfaces, WhatTurnsOutToLackAxesOnceItIsOpenIsGivenBack) {
  test::EmulatedInterface face = hid(0x81, mouseDescriptor());
  face.kernelDriver = "other";
  plug(0xc635, {face});
  EXPECT_TRUE(listed().isUsable()) << "nobody knows yet";
  SpaceMouseDevice mouse(seen());
  EXPECT_EQ(problemOfStart(mouse), DeviceProblem::Unsupported);
  EXPECT_EQ(mouse.state(), DeviceState::Present);
  EXPECT_TRUE(device->isKernelDriverBound(0));
  EXPECT_FALSE(device->isOpen());
}

TEST_F(SpaceMouseInterfaces, AKnownModelThatKeepsItsDescriptorToItselfIsReadAsKnown) {
  plug(0xc635, {hid(0x81, {})});
  test::SpaceMouseFirmware firmware(Model::Pro);
  SpaceMouseDevice mouse(seen());
  mouse.start({});
  firmware.counts = {0, 0, -350, 0, 0, 0};
  device->send(0x81, firmware.reports().at(0));
  EXPECT_TRUE(test::eventually([&] { return mouse.newest().axes[2] == 1.0; }));
}

TEST_F(SpaceMouseInterfaces, AnUnknownModelThatKeepsItsDescriptorToItselfIsRefused) {
  plug(0xc6ff, {hid(0x81, {})});
  SpaceMouseDevice mouse(seen());
  EXPECT_EQ(problemOfStart(mouse), DeviceProblem::Unsupported);
}

TEST_F(SpaceMouseInterfaces, CadMiceStayWithTheDesktop) {
  plug(0xc650, {hid(0x81, mouseDescriptor(), 2)});
  const DeviceListing listing = listed();
  EXPECT_EQ(listing.problem, DeviceProblem::Unsupported);
  EXPECT_THAT(listing.reason, HasSubstr("ordinary mouse"));
  SpaceMouseDevice mouse(seen());
  EXPECT_EQ(problemOfStart(mouse), DeviceProblem::Unsupported);
  EXPECT_TRUE(device->isKernelDriverBound(0));
}

TEST_F(SpaceMouseInterfaces, WhatIsGoneWhenItIsToBeOpenedIsAbsent) {
  plug(0xc635, {hid(0x81, test::spaceMouseProDescriptor())});
  SpaceMouseDevice mouse(seen());
  EXPECT_EQ(mouse.state(), DeviceState::Present);
  bus.unplug(*device);
  EXPECT_EQ(problemOfStart(mouse), DeviceProblem::Gone);
  EXPECT_EQ(mouse.state(), DeviceState::Absent);
}

}  // namespace
}  // namespace nearfit::spacemouse_interfaces_test
