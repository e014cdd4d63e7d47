#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include <gtest/gtest.h>

#include "device/usb/usb_bus.h"
#include "device/usb/usb_link.h"
#include "tests/support/eventually.h"
#include "tests/usb/emulated_bus.h"
#include "tests/usb/report_stream.h"

namespace nearfit::test {

constexpr std::uint8_t kIn = 0x81, kOut = 0x02;
constexpr std::size_t kPacketSize = 64;

/// A device of one vendor interface with an interrupt endpoint each way, a packet a millisecond.
EmulatedDescription plainDescription();
std::shared_ptr<EmulatedDevice> plainDevice();

/// A packet that carries a number.
Bytes numbered(std::uint64_t number, std::size_t size = kPacketSize);
std::uint64_t numberIn(std::span<const std::byte> packet);

/// Keeps what a link says.
class RecordingSink final : public UsbPacketSink {
 public:
  /// Called for each packet, on the link's thread; set before it streams.
  std::function<void(std::span<const std::byte>)> onEach;

  void onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept override;
  void onLost(UsbLoss loss) noexcept override;

  std::vector<Bytes> packets() const;
  std::size_t count() const;
  std::vector<std::int64_t> arrivals() const;
  std::vector<UsbLoss> losses() const;

 private:
  mutable std::mutex mutex_;
  std::vector<Bytes> packets_;
  std::vector<std::int64_t> arrivals_;
  std::vector<UsbLoss> losses_;
};

/// A bus with a plain device in it.
class UsbLinkTest : public testing::Test {
 protected:
  UsbLinkTest();

  /// What the program sees of the device in a port.
  static UsbDescription seen(unsigned port = 1);
  /// Of the whole bus, opened anew.
  static std::vector<UsbDescription> seenAll();

  EmulatedBus bus;
  std::shared_ptr<EmulatedDevice> device = plainDevice();
};

}  // namespace nearfit::test
