#include "tests/usb/falcon_emulator.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "tests/usb/report_stream.h"

namespace nearfit::test {
namespace {

constexpr std::uint8_t kBulkIn = 0x81, kBulkOut = 0x02;
constexpr std::size_t kPacket = 64, kStatus = 2;
constexpr std::chrono::milliseconds kLatency{1};
/// How often it looks whether it is to end, while nobody asks.
constexpr std::chrono::milliseconds kEndGlance{20};

EmulatedDescription describe() {
  EmulatedDescription description;
  description.vendor = 0x0403;
  description.product = 0xcb48;
  description.manufacturer = "Novint";
  description.productName = "FALCON HAPTIC";
  description.speed = 12;
  description.interfaces = {
      {.endpoints =
           {{.address = kBulkIn, .type = UsbTransferType::Bulk, .maxPacket = kPacket, .interval = 0},
            {.address = kBulkOut, .type = UsbTransferType::Bulk, .maxPacket = kPacket, .interval = 0}},
       .kernelDriver = "ftdi_sio"}};
  return description;
}

}  // namespace

FalconEmulator::FalconEmulator(FalconFirmware::Bytes image)
    : firmware_(std::move(image)), device_(std::make_shared<EmulatedDevice>(describe())) {
  device_->onControl = [this](const ControlRequest& request) -> std::optional<Bytes> {
    const std::lock_guard lock(mutex_);
    if (!firmware_.onRequest(request.type, request.request, request.value)) return std::nullopt;
    return Bytes{};
  };
  device_->onPacket = [this](std::uint8_t endpoint, std::span<const std::byte> packet) {
    const std::lock_guard lock(mutex_);
    if (endpoint != kBulkOut) return;
    if (hand_) hand_(firmware_);
    firmware_.onBytes(packet);
    hasBytes_.notify_one();
  };
  chip_ = std::thread([this] { run(); });
}

FalconEmulator::~FalconEmulator() {
  isStopping_.store(true);
  chip_.join();
}

void FalconEmulator::moveWith(std::function<void(FalconFirmware&)> hand) {
  const std::lock_guard lock(mutex_);
  hand_ = std::move(hand);
}

void FalconEmulator::run() {
  Nanoseconds due = 0;
  while (!isStopping_.load()) {
    if (const Nanoseconds period = period_.load(); period > 0) {
      due = std::max(due + period, monotonicNow());
      sleepUntil(due);
    }
    Bytes packet{std::byte{0x01}, std::byte{0x60}};
    {
      std::unique_lock lock(mutex_);
      hasBytes_.wait_for(lock, kLatency, [this] { return firmware_.hasBytes(); });
      const Bytes content = firmware_.takeBytes(kPacket - kStatus);
      packet.insert(packet.end(), content.begin(), content.end());
    }
    while (!isStopping_.load()) {
      const auto sending = device_->send(kBulkIn, packet, kEndGlance);
      if (sending == EmulatedDevice::Sending::NobodyAsked) continue;
      if (sending == EmulatedDevice::Sending::Unplugged) std::this_thread::sleep_for(kEndGlance);
      break;
    }
  }
}

}  // namespace nearfit::test
