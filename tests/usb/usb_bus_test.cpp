#include "device/usb/usb_bus.h"

#include <gtest/gtest.h>

#include "tests/usb/usb_fixture.h"

namespace nearfit::usb_bus_test {
namespace {

using test::eventually;

TEST(UsbBus, EmptyBusListsNothing) {
  const test::EmulatedBus emulated;
  EXPECT_TRUE(UsbBus().list().empty());
}

TEST(UsbBus, ListsADeviceAsItsDescriptorsTellIt) {
  test::EmulatedBus emulated;
  test::EmulatedDescription told;
  told.vendor = 0x256f;
  told.product = 0xc635;
  told.release = 0x0437;
  told.interfaces = {{.classCode = 3,
                      .subclass = 1,
                      .protocol = 2,
                      .endpoints = {{.address = 0x83, .maxPacket = 16, .interval = 7}},
                      .reportDescriptor = {std::byte{5}, std::byte{1}}},
                     {.endpoints = {{.address = 0x84, .type = UsbTransferType::Bulk, .maxPacket = 512},
                                    {.address = 0x05, .type = UsbTransferType::Bulk, .maxPacket = 512}}}};
  const std::uint8_t address = emulated.plug(std::make_shared<test::EmulatedDevice>(told), 3);

  const std::vector<UsbDescription> seen = UsbBus().list();
  ASSERT_EQ(seen.size(), 1U);
  const UsbDescription& device = seen[0];
  EXPECT_EQ(device.id(), "256f:c635");
  EXPECT_EQ(device.release, 0x0437);
  EXPECT_EQ(device.bus, test::EmulatedBus::kBus);
  EXPECT_EQ(device.address, address);
  EXPECT_EQ(device.place(), "1-3");
  ASSERT_EQ(device.interfaces.size(), 2U);
  const UsbInterface& hid = device.interfaces[0];
  EXPECT_EQ(hid.number, 0);
  EXPECT_EQ(hid.classCode, 3);
  EXPECT_EQ(hid.subclass, 1);
  EXPECT_EQ(hid.protocol, 2);
  ASSERT_EQ(hid.endpoints.size(), 1U);
  EXPECT_EQ(hid.endpoints[0].address, 0x83);
  EXPECT_EQ(hid.endpoints[0].maxPacket, 16);
  // At high speed 2^(7 - 1) microframes of 125 us.
  EXPECT_DOUBLE_EQ(hid.endpoints[0].interval, 8e-3);
  EXPECT_EQ(hid.streaming(false), nullptr);
  ASSERT_NE(device.interfaces[1].streaming(false), nullptr);
  EXPECT_EQ(device.interfaces[1].streaming(false)->type, UsbTransferType::Bulk);
}

TEST(UsbBus, IntervalsOfFullSpeedDevicesAreMilliseconds) {
  test::EmulatedBus emulated;
  test::EmulatedDescription told = test::plainDescription();
  told.speed = 12;
  told.interfaces[0].endpoints[0].interval = 10;
  emulated.plug(std::make_shared<test::EmulatedDevice>(told));
  const std::vector<UsbDescription> seen = UsbBus().list();
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_DOUBLE_EQ(seen[0].interfaces.at(0).endpoints.at(0).interval, 10e-3);
}

TEST(UsbBus, SeesDevicesComeAndGo) {
  test::EmulatedBus emulated;
  const UsbBus bus;
  ASSERT_TRUE(bus.tellsOfChanges());
  EXPECT_EQ(bus.changes(), 0U);
  const auto device = test::plainDevice();
  emulated.plug(device);
  EXPECT_TRUE(eventually([&] { return bus.changes() == 1; }));
  ASSERT_EQ(bus.list().size(), 1U);
  const UsbDescription first = bus.list()[0];
  emulated.unplug(*device);
  EXPECT_TRUE(eventually([&] { return bus.changes() == 2; }));
  EXPECT_TRUE(bus.list().empty());
  emulated.plug(device);
  EXPECT_TRUE(eventually([&] { return bus.changes() == 3; }));
  ASSERT_EQ(bus.list().size(), 1U);
  EXPECT_FALSE(bus.list()[0].isSamePlugging(first));
  EXPECT_EQ(bus.list()[0].place(), first.place());
}

TEST(UsbBus, TwoDevicesOfAKindAreToldApart) {
  test::EmulatedBus emulated;
  emulated.plug(test::plainDevice(), 2);
  emulated.plug(test::plainDevice(), 1);
  const std::vector<UsbDescription> seen = UsbBus().list();
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[0].place(), "1-2");
  EXPECT_EQ(seen[1].place(), "1-1");
  EXPECT_FALSE(seen[0].isSamePlugging(seen[1]));
}

}  // namespace
}  // namespace nearfit::usb_bus_test
