#include <array>
#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::usb_link_open_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class UsbLinkOpen : public test::UsbLinkTest {
 protected:
  /// What opening it fails with.
  DeviceError failureOf(const UsbDescription& description, std::uint8_t interfaceNumber = 0) {
    try {
      const UsbLink link(description, interfaceNumber);
    } catch (const DeviceError& error) {
      return error;
    }
    ADD_FAILURE() << "it could be opened";
    return {DeviceProblem::Failed, "", ""};
  }
};

TEST_F(UsbLinkOpen, ClaimsTheInterfaceAndGivesItBack) {
  {
    const UsbLink link(seen(), 0);
    EXPECT_TRUE(device->isClaimed(0));
  }
  EXPECT_FALSE(device->isClaimed(0));
  EXPECT_FALSE(device->isOpen());
}

TEST_F(UsbLinkOpen, TheSystemsDriverIsDetachedAndAttachedAgain) {
  test::EmulatedDescription told = test::plainDescription();
  told.interfaces[0].kernelDriver = "usbhid";
  const auto hid = std::make_shared<test::EmulatedDevice>(told);
  bus.plug(hid, 2);
  ASSERT_TRUE(hid->isKernelDriverBound(0));
  {
    const UsbLink link(seen(2), 0);
    EXPECT_TRUE(hid->isClaimed(0));
    EXPECT_FALSE(hid->isKernelDriverBound(0));
  }
  EXPECT_TRUE(hid->isKernelDriverBound(0));
}

TEST_F(UsbLinkOpen, WhatAnotherProgramHoldsIsBusy) {
  device->claimElsewhere(0, true);
  const DeviceError error = failureOf(seen());
  EXPECT_EQ(error.cause(), DeviceProblem::Busy);
  EXPECT_THAT(error.what(), HasSubstr("another program is using it"));
  EXPECT_THAT(error.remedy(), HasSubstr("close the program"));
  EXPECT_FALSE(device->isOpen());
  device->claimElsewhere(0, false);
  EXPECT_NO_THROW(UsbLink(seen(), 0));
}

TEST_F(UsbLinkOpen, OneLinkKeepsAnotherOut) {
  const UsbLink link(seen(), 0);
  EXPECT_EQ(failureOf(seen()).cause(), DeviceProblem::Busy);
  EXPECT_TRUE(device->isClaimed(0));
}

TEST_F(UsbLinkOpen, WithoutPermissionTheUdevRuleIsNamed) {
  device->denyPermission(true);
  const DeviceError error = failureOf(seen());
  EXPECT_EQ(error.cause(), DeviceProblem::NoPermission);
  EXPECT_THAT(error.what(), HasSubstr("/dev/bus/usb/001/002"));
  EXPECT_THAT(error.remedy(), HasSubstr("udev rules"));
}

TEST_F(UsbLinkOpen, WhatWasUnpluggedIsGone) {
  const UsbDescription before = seen();
  bus.unplug(*device);
  EXPECT_EQ(failureOf(before).cause(), DeviceProblem::Gone);
  // Plugged in again it is another: whoever held the old description looks anew.
  bus.plug(device);
  EXPECT_EQ(failureOf(before).cause(), DeviceProblem::Gone);
  EXPECT_NO_THROW(UsbLink(seen(), 0));
}

TEST_F(UsbLinkOpen, AnInterfaceThatItLacksCannotBeClaimed) {
  EXPECT_EQ(failureOf(seen(), 5).cause(), DeviceProblem::Unsupported);
  EXPECT_FALSE(device->isOpen());
}

TEST_F(UsbLinkOpen, ReadsStrings) {
  test::EmulatedDescription told = test::plainDescription();
  told.manufacturer = "Maker & Co";
  told.productName = "Stylus\x1b[2J";
  told.serial = "0042";
  bus.plug(std::make_shared<test::EmulatedDevice>(told), 2);
  const UsbLink::Strings strings = UsbLink(seen(2), 0).strings();
  EXPECT_EQ(strings.manufacturer, "Maker & Co");
  // Nothing in it may steer a terminal.
  EXPECT_EQ(strings.product, "Stylus?[2J");
  EXPECT_EQ(strings.serial, "0042");
}

TEST_F(UsbLinkOpen, RequestsGoBothWays) {
  test::ControlRequest got;
  test::Bytes gotData;
  device->onControl = [&](const test::ControlRequest& request) -> std::optional<test::Bytes> {
    got = request;
    gotData = test::bytesOf(request.data);
    return test::numbered(77, 8);
  };
  UsbLink link(seen(), 0);
  std::array<std::byte, 16> data{};
  EXPECT_EQ(link.controlIn(0xc1, 9, 0x1234, 5, data, 1s), 8U);
  EXPECT_EQ(test::numberIn(data), 77U);
  EXPECT_EQ(got.type, 0xc1);
  EXPECT_EQ(got.request, 9);
  EXPECT_EQ(got.value, 0x1234);
  EXPECT_EQ(got.index, 5);
  EXPECT_EQ(got.length, 16);
  const test::Bytes sent = test::numbered(123456789);
  link.controlOut(0x41, 10, 1, 0, sent, 1s);
  EXPECT_EQ(got.type, 0x41);
  EXPECT_EQ(gotData, sent);
}

TEST_F(UsbLinkOpen, RequestsThatAreStalledOrNotAnsweredSaySo) {
  device->onControl = [](const test::ControlRequest&) { return std::nullopt; };
  UsbLink link(seen(), 0);
  const auto causeOf = [&](auto&& call) {
    try {
      call();
    } catch (const DeviceError& error) {
      return error.cause();
    }
    ADD_FAILURE() << "it was answered";
    return DeviceProblem::Failed;
  };
  std::array<std::byte, 16> data{};
  EXPECT_EQ(causeOf([&] { link.controlOut(0x41, 1, 0, 0, {}, 1s); }), DeviceProblem::NotAnswering);
  device->hang(true);
  EXPECT_EQ(causeOf([&] { link.controlIn(0xc1, 1, 0, 0, data, 20ms); }), DeviceProblem::NotAnswering);
  EXPECT_EQ(causeOf([&] { link.read(test::kIn, data, 20ms); }), DeviceProblem::NotAnswering);
  EXPECT_EQ(causeOf([&] { link.write(test::kOut, data, 20ms); }), DeviceProblem::NotAnswering);
  EXPECT_EQ(device->outstanding(), 0U);
  bus.unplug(*device);
  EXPECT_EQ(causeOf([&] { link.controlIn(0xc1, 1, 0, 0, data, 1s); }), DeviceProblem::Gone);
}

TEST_F(UsbLinkOpen, ReadsAndWritesSinglePackets) {
  test::Bytes got;
  device->onPacket = [&](std::uint8_t, std::span<const std::byte> packet) { got = test::bytesOf(packet); };
  UsbLink link(seen(), 0);
  link.write(test::kOut, test::numbered(5), 1s);
  EXPECT_EQ(got, test::numbered(5));
  std::thread sender([&] { device->send(test::kIn, test::numbered(6)); });
  std::array<std::byte, 64> data{};
  EXPECT_EQ(link.read(test::kIn, data, 10s), 64U);
  sender.join();
  EXPECT_EQ(test::numberIn(data), 6U);
}

}  // namespace
}  // namespace nearfit::usb_link_open_test
