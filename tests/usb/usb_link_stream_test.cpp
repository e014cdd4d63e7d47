#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::usb_link_stream_test {
namespace {

using test::eventually;
using test::numbered;
using test::numberIn;
using testing::ElementsAre;

class UsbLinkStream : public test::UsbLinkTest {
 protected:
  UsbLinkStream() {
    device->onPacket = [this](std::uint8_t, std::span<const std::byte> packet) {
      const std::lock_guard lock(mutex_);
      commands_.push_back(numberIn(packet));
    };
  }

  /// Numbers of the packets that the device took.
  std::vector<std::uint64_t> commands() const {
    const std::lock_guard lock(mutex_);
    return commands_;
  }

  static constexpr UsbLink::Streams kBoth{test::kIn, test::kOut};
  test::RecordingSink sink;

 private:
  mutable std::mutex mutex_;
  std::vector<std::uint64_t> commands_;
};

TEST_F(UsbLinkStream, FiveThousandReportsAtAKilohertzAreEachAnsweredAndNoneIsLost) {
  constexpr std::uint64_t kCount = 5000;
  std::atomic<std::uint64_t> answered{0};
  device->onPacket = [&](std::uint8_t, std::span<const std::byte> packet) {
    EXPECT_EQ(numberIn(packet), answered.load());
    ++answered;
  };
  UsbLink link(seen(), 0);
  sink.onEach = [&](std::span<const std::byte> packet) { EXPECT_TRUE(link.send(packet)); };
  link.stream(kBoth, sink);
  test::ReportStream reports(*device, {.endpoint = test::kIn,
                                       .rate = 1000.0,
                                       .count = kCount,
                                       .report = [](std::uint64_t i) { return numbered(i); },
                                       .mayGo = [&](std::uint64_t i) { return answered.load() >= i; }});
  reports.join();
  EXPECT_TRUE(eventually([&] { return link.counters().commands == kCount; }));
  EXPECT_EQ(reports.counts().sent, kCount);
  EXPECT_EQ(reports.counts().lost, 0U);
  EXPECT_EQ(link.counters().packets, kCount);
  EXPECT_EQ(link.counters().replaced, 0U);
  EXPECT_EQ(link.loss(), UsbLoss::None);
  const std::vector<test::Bytes> packets = sink.packets();
  ASSERT_EQ(packets.size(), kCount);
  for (std::uint64_t i = 0; i < kCount; ++i)
    ASSERT_EQ(numberIn(packets[i]), i);
  std::printf("waited for a transfer: %llu, for an answer: %llu of %llu\n",
              static_cast<unsigned long long>(reports.counts().waited),
              static_cast<unsigned long long>(reports.counts().delayed),
              static_cast<unsigned long long>(kCount));
}

TEST_F(UsbLinkStream, BurstsOfReportsAreTakenInOrder) {
  UsbLink link(seen(), 0);
  link.stream(kBoth, sink);
  constexpr std::uint64_t kCount = 500;
  for (std::uint64_t i = 0; i < kCount; ++i)
    ASSERT_NE(device->send(test::kIn, numbered(i)), test::EmulatedDevice::Sending::NobodyAsked);
  ASSERT_TRUE(eventually([&] { return sink.count() == kCount; }));
  const std::vector<test::Bytes> packets = sink.packets();
  for (std::uint64_t i = 0; i < kCount; ++i)
    ASSERT_EQ(numberIn(packets[i]), i);
}

TEST_F(UsbLinkStream, TheNewestCommandWins) {
  UsbLink link(seen(), 0);
  link.stream(kBoth, sink);
  device->hang(true);
  // Two are on their way; what comes after waits, and is replaced.
  for (const std::uint64_t number : {1U, 2U}) {
    ASSERT_TRUE(link.send(numbered(number)));
    ASSERT_TRUE(device->waitForRequests(test::kOut, number));
  }
  for (const std::uint64_t number : {3U, 4U, 5U})
    ASSERT_TRUE(link.send(numbered(number)));
  device->hang(false);
  ASSERT_TRUE(eventually([&] { return link.counters().commands == 3; }));
  EXPECT_THAT(commands(), ElementsAre(1, 2, 5));
  EXPECT_EQ(link.counters().replaced, 2U);
}

TEST_F(UsbLinkStream, ShortAndEmptyReportsAreHandedOnAsTheyAre) {
  UsbLink link(seen(), 0);
  link.stream(kBoth, sink);
  for (const std::size_t size : {std::size_t{1}, std::size_t{0}, std::size_t{63}, test::kPacketSize})
    device->send(test::kIn, numbered(size, size));
  ASSERT_TRUE(eventually([&] { return sink.count() == 4; }));
  const std::vector<test::Bytes> packets = sink.packets();
  EXPECT_EQ(packets[0].size(), 1U);
  EXPECT_EQ(packets[1].size(), 0U);
  EXPECT_EQ(packets[2].size(), 63U);
  EXPECT_EQ(packets[3].size(), test::kPacketSize);
  EXPECT_EQ(link.loss(), UsbLoss::None);
}

TEST_F(UsbLinkStream, OversizedReportsAreCountedAndThrownAway) {
  UsbLink link(seen(), 0);
  link.stream(kBoth, sink);
  for (std::uint64_t i = 0; i < 20; ++i)
    device->send(test::kIn, numbered(i, 2 * test::kPacketSize));
  device->send(test::kIn, numbered(99));
  ASSERT_TRUE(eventually([&] { return sink.count() == 1; }));
  EXPECT_EQ(numberIn(sink.packets()[0]), 99U);
  EXPECT_EQ(link.counters().oversized, 20U);
  EXPECT_EQ(link.loss(), UsbLoss::None);
}

TEST_F(UsbLinkStream, CommandsThatAreTooLongOrHaveNoEndpointAreRefused) {
  UsbLink link(seen(), 0);
  EXPECT_FALSE(link.send(numbered(1)));
  link.stream({test::kIn, 0}, sink);
  EXPECT_FALSE(link.send(numbered(1)));
  link.stream(kBoth, sink);
  EXPECT_FALSE(link.send(numbered(1, UsbLink::kMaxPacket + 1)));
  EXPECT_TRUE(link.send(numbered(1, 32)));
  EXPECT_TRUE(eventually([&] { return commands().size() == 1; }));
}

TEST_F(UsbLinkStream, EndpointsOfTheWrongKindAreRefused) {
  UsbLink link(seen(), 0);
  EXPECT_THROW(link.stream({test::kOut, test::kOut}, sink), DeviceError);
  EXPECT_THROW(link.stream({test::kIn, test::kIn}, sink), DeviceError);
  EXPECT_THROW(link.stream({0x83, 0}, sink), DeviceError);
  EXPECT_EQ(device->outstanding(), 0U);
}

TEST_F(UsbLinkStream, RequestsAreAnsweredWhileItStreams) {
  device->onControl = [](const test::ControlRequest& request) -> std::optional<test::Bytes> {
    if (request.request == 0) return std::nullopt;
    return numbered(request.value, 8);
  };
  UsbLink link(seen(), 0);
  std::atomic<std::uint64_t> handled{0};
  sink.onEach = [&](std::span<const std::byte> packet) {
    link.send(packet);
    ++handled;
  };
  link.stream(kBoth, sink);
  test::ReportStream reports(*device,
                             {.endpoint = test::kIn, .report = [](std::uint64_t i) { return numbered(i); }});
  using namespace std::chrono_literals;
  for (std::uint16_t i = 0; i < 200; ++i) {
    std::array<std::byte, 8> data{};
    ASSERT_EQ(link.controlIn(0xc1, 1, i, 0, data, 10s), 8U);
    ASSERT_EQ(numberIn(data), i);
  }
  EXPECT_THROW(link.controlOut(0x41, 0, 0, 0, {}, 10s), DeviceError);
  device->hang(true);
  EXPECT_THROW(link.controlOut(0x41, 1, 0, 0, {}, 20ms), DeviceError);
  device->hang(false);
  const std::uint64_t before = handled.load();
  EXPECT_TRUE(eventually([&] { return handled.load() > before; }));
  EXPECT_EQ(link.loss(), UsbLoss::None);
}

TEST_F(UsbLinkStream, TwoDevicesStreamAtOnce) {
  const auto other = test::plainDevice();
  bus.plug(other, 2);
  std::array<std::atomic<std::uint64_t>, 2> answered{};
  std::array<test::EmulatedDevice*, 2> devices{device.get(), other.get()};
  std::array<test::RecordingSink, 2> sinks;
  std::array<std::unique_ptr<UsbLink>, 2> links;
  for (std::size_t d = 0; d < 2; ++d) {
    devices[d]->onPacket = [&, d](std::uint8_t, std::span<const std::byte> packet) {
      EXPECT_EQ(numberIn(packet) % 2, d);
      ++answered[d];
    };
    links[d] = std::make_unique<UsbLink>(seen(static_cast<unsigned>(d + 1)), std::uint8_t{0});
    sinks[d].onEach = [&, d](std::span<const std::byte> packet) { links[d]->send(packet); };
    links[d]->stream(kBoth, sinks[d]);
  }
  constexpr std::uint64_t kCount = 500;
  {
    const auto plan = [&](std::size_t d) {
      return test::ReportStream::Plan{.endpoint = test::kIn,
                                      .rate = 1000.0,
                                      .count = kCount,
                                      .report = [d](std::uint64_t i) { return numbered(2 * i + d); },
                                      .mayGo = [&, d](std::uint64_t i) { return answered[d].load() >= i; }};
    };
    test::ReportStream first(*device, plan(0)), second(*other, plan(1));
    first.join();
    second.join();
    EXPECT_EQ(first.counts().sent, kCount);
    EXPECT_EQ(second.counts().sent, kCount);
  }
  // One is unplugged: the other does not mind.
  bus.unplug(*device);
  EXPECT_TRUE(eventually([&] { return sinks[0].losses().size() == 1; }));
  other->send(test::kIn, numbered(2 * kCount + 1));
  EXPECT_TRUE(eventually([&] { return sinks[1].count() == kCount + 1; }));
  EXPECT_EQ(links[1]->loss(), UsbLoss::None);
  EXPECT_EQ(sinks[1].losses().size(), 0U);
}

}  // namespace
}  // namespace nearfit::usb_link_stream_test
