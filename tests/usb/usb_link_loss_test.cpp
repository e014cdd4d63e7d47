#include <cerrno>
#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::usb_link_loss_test {
namespace {

using test::eventually;
using test::numbered;
using test::Unplugging;
using testing::AnyOf;
using testing::ElementsAre;
using testing::Eq;

constexpr UsbLink::Streams kBoth{test::kIn, test::kOut};

class UsbLinkLoss : public test::UsbLinkTest {
 protected:
  void SetUp() override {
    link = std::make_unique<UsbLink>(seen(), std::uint8_t{0});
    link->stream(kBoth, sink);
    ASSERT_TRUE(device->waitForRequests(test::kIn, 4));
  }

  /// It is lost, for what `how` says, and said so once; afterwards nothing is in flight.
  void expectLost(const testing::Matcher<UsbLoss>& how) {
    ASSERT_TRUE(eventually([&] { return !sink.losses().empty(); }));
    EXPECT_THAT(link->loss(), how);
    EXPECT_FALSE(link->send(numbered(1)));
    link->stop();
    EXPECT_EQ(device->outstanding(), 0U);
    EXPECT_THAT(sink.losses(), ElementsAre(how));
    EXPECT_THAT(link->loss(), how) << "it is remembered";
    link.reset();
    EXPECT_EQ(device->leftAtClose(), 0U);
    EXPECT_FALSE(device->isOpen());
  }

  test::RecordingSink sink;
  std::unique_ptr<UsbLink> link;
};

class UsbLinkUnplugged : public UsbLinkLoss, public testing::WithParamInterface<Unplugging> {};

TEST_P(UsbLinkUnplugged, InMidStreamIsLostOnceAndWorksWhenPluggedInAgain) {
  sink.onEach = [&](std::span<const std::byte> packet) { link->send(packet); };
  {
    const test::ReportStream reports(
        *device, {.endpoint = test::kIn, .report = [](std::uint64_t i) { return numbered(i); }});
    ASSERT_TRUE(eventually([&] { return sink.count() >= 50; }));
    bus.unplug(*device, GetParam());
  }
  // Which of its signs comes first is a race, in the kernel too.
  const bool mayBeErrors = GetParam() == Unplugging::Protocol;
  using Loss = testing::Matcher<UsbLoss>;
  const Loss unplugged = AnyOf(UsbLoss::Unplugged, UsbLoss::Refused);
  expectLost(mayBeErrors ? Loss(AnyOf(unplugged, UsbLoss::Errors)) : unplugged);

  bus.plug(device);
  test::RecordingSink again;
  UsbLink second(seen(), 0);
  second.stream(kBoth, again);
  // Its thread may not have asked for anything yet.
  ASSERT_TRUE(device->waitForRequests(test::kIn, 1));
  ASSERT_EQ(device->send(test::kIn, numbered(7)), test::EmulatedDevice::Sending::Taken);
  EXPECT_TRUE(eventually([&] { return again.count() == 1; }));
  EXPECT_EQ(second.loss(), UsbLoss::None);
}

INSTANTIATE_TEST_SUITE_P(EachWay, UsbLinkUnplugged,
                         testing::Values(Unplugging::NoDevice, Unplugging::Shutdown, Unplugging::Protocol,
                                         Unplugging::Cancelled),
                         [](const auto& instance) -> std::string {
                           switch (instance.param) {
                             case Unplugging::NoDevice:
                               return "NoDevice";
                             case Unplugging::Shutdown:
                               return "Shutdown";
                             case Unplugging::Protocol:
                               return "Protocol";
                             case Unplugging::Cancelled:
                               return "Cancelled";
                           }
                           return "";
                         });

TEST_F(UsbLinkLoss, NothingButErrorsIsALoss) {
  device->fail(EPROTO);
  expectLost(Eq(UsbLoss::Errors));
}

TEST_F(UsbLinkLoss, AFewErrorsAreForgotten) {
  for (int burst = 0; burst < 10; ++burst) {
    device->breakOff(EPROTO);
    ASSERT_TRUE(device->waitForRequests(test::kIn, 4));
    device->send(test::kIn, numbered(1));
  }
  EXPECT_TRUE(eventually([&] { return sink.count() == 10; }));
  EXPECT_EQ(link->loss(), UsbLoss::None);
}

TEST_F(UsbLinkLoss, ShutdownIsUnplugging) {
  device->fail(ESHUTDOWN);
  expectLost(Eq(UsbLoss::Unplugged));
}

TEST_F(UsbLinkLoss, AStallIsClearedAndStreamsOn) {
  for (unsigned i = 0; i < 10; ++i) {
    device->stall(test::kIn);
    device->send(test::kIn, numbered(i));
    ASSERT_TRUE(eventually([&] { return sink.count() == i + 1; }));
    ASSERT_TRUE(device->waitForRequests(test::kIn, 4));
  }
  EXPECT_EQ(device->haltsCleared(), 10U);
  EXPECT_EQ(link->loss(), UsbLoss::None);
}

TEST_F(UsbLinkLoss, AStalledCommandEndpointIsClearedToo) {
  device->stall(test::kOut);
  ASSERT_TRUE(link->send(numbered(1)));
  ASSERT_TRUE(eventually([&] { return device->haltsCleared() == 1; }));
  ASSERT_TRUE(link->send(numbered(2)));
  EXPECT_TRUE(eventually([&] { return link->counters().commands == 1; }));
  EXPECT_EQ(link->loss(), UsbLoss::None);
}

TEST_F(UsbLinkLoss, StallsWithoutEndAreALoss) {
  device->stall(test::kIn, true);
  expectLost(Eq(UsbLoss::Stalled));
}

TEST_F(UsbLinkLoss, ReportsDoNotExcuseACommandEndpointThatStallsForGood) {
  device->stall(test::kOut, true);
  sink.onEach = [&](std::span<const std::byte> packet) { link->send(packet); };
  const test::ReportStream reports(
      *device, {.endpoint = test::kIn, .report = [](std::uint64_t i) { return numbered(i); }});
  expectLost(Eq(UsbLoss::Stalled));
}

TEST_F(UsbLinkLoss, ASilentDeviceIsStoppedSoon) {
  device->hang(true);
  ASSERT_TRUE(link->send(numbered(1)));
  ASSERT_TRUE(link->send(numbered(2)));
  ASSERT_TRUE(device->waitForRequests(test::kOut, 1));
  const auto begin = std::chrono::steady_clock::now();
  link->stop();
  // A second is what it waits at most for what it cancelled; the rest is a loaded machine's.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
  EXPECT_EQ(device->outstanding(), 0U);
  EXPECT_EQ(link->loss(), UsbLoss::None);
  EXPECT_TRUE(sink.losses().empty());
}

TEST_F(UsbLinkLoss, CanBeStreamedAgainAfterStopping) {
  for (std::size_t i = 1; i <= 20; ++i) {
    link->stop();
    EXPECT_EQ(device->outstanding(), 0U);
    link->stream(kBoth, sink);
    device->send(test::kIn, numbered(i));
    ASSERT_TRUE(eventually([&] { return sink.count() == i; }));
  }
  EXPECT_EQ(link->loss(), UsbLoss::None);
}

TEST_F(UsbLinkLoss, RequestsAfterALossFailAndReturn) {
  bus.unplug(*device);
  ASSERT_TRUE(eventually([&] { return !sink.losses().empty(); }));
  EXPECT_THROW(link->controlOut(0x41, 1, 0, 0, {}, std::chrono::seconds(1)), DeviceError);
}

}  // namespace
}  // namespace nearfit::usb_link_loss_test
