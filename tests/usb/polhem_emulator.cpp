#include "tests/usb/polhem_emulator.h"

#include <utility>

namespace nearfit::test {
namespace {

constexpr std::uint8_t kHidClass = 3, kInterruptIn = 0x81, kInterruptOut = 0x01;

/// As the board's firmware describes itself, in full speed: intervals are milliseconds.
EmulatedDescription describe(PolhemEmulator::Board board) {
  EmulatedDescription description;
  description.speed = 12;
  description.manufacturer = "Makers";
  description.productName = "WoodenHaptics emulator";
  description.interfaces = {{.classCode = kHidClass,
                             .endpoints = {{.address = kInterruptIn, .maxPacket = 64, .interval = 1},
                                           {.address = kInterruptOut, .maxPacket = 64, .interval = 1}},
                             .kernelDriver = "usbhid"}};
  if (board == PolhemEmulator::Board::Own) {
    description.vendor = 0x1234;
    description.product = 0x0006;
    return description;
  }
  description.vendor = 0x16c0;
  description.product = 0x0486;
  // For text: it takes half a packet.
  description.interfaces.push_back({.classCode = kHidClass,
                                    .endpoints = {{.address = 0x82, .maxPacket = 64, .interval = 1},
                                                  {.address = 0x02, .maxPacket = 32, .interval = 1}},
                                    .kernelDriver = "usbhid"});
  return description;
}

}  // namespace

PolhemEmulator::PolhemEmulator(Board board)
    : firmware_(board == Board::Own ? PolhemFirmware::kPacket : 64),
      device_(std::make_shared<EmulatedDevice>(describe(board))) {
  device_->onControl = [](const ControlRequest&) { return std::nullopt; };
  device_->onPacket = [this](std::uint8_t endpoint, std::span<const std::byte> packet) {
    const std::lock_guard lock(mutex_);
    if (endpoint == kInterruptOut) firmware_.onPacket(packet);
  };
}

void PolhemEmulator::stream(const Motion& motion) {
  stopStreaming();
  ReportStream::Plan plan;
  plan.endpoint = kInterruptIn;
  plan.rate = motion.rate;
  plan.count = motion.count;
  plan.isPatient = motion.count == 0;
  plan.report = [this, motion](std::uint64_t) { return report(motion); };
  plan.mayGo = [this, before = sent_](std::uint64_t report) {
    return withFirmware([&](const PolhemFirmware& firmware) { return firmware.accepted(); }) >
           before + report;
  };
  reports_.emplace(*device_, std::move(plan));
}

Bytes PolhemEmulator::report(const Motion& motion) {
  const std::lock_guard lock(mutex_);
  if (motion.hand) motion.hand(firmware_);
  Bytes bytes = firmware_.report();
  if (damage_) std::exchange(damage_, nullptr)(bytes);
  return bytes;
}

void PolhemEmulator::damageNext(std::function<void(Bytes&)> damage) {
  const std::lock_guard lock(mutex_);
  damage_ = std::move(damage);
}

void PolhemEmulator::powerOff() {
  stopStreaming();
  withFirmware([](PolhemFirmware& firmware) { firmware.powerOff(); });
  sent_ = withFirmware([](const PolhemFirmware& firmware) { return firmware.accepted(); });
}

void PolhemEmulator::stopStreaming() {
  if (!reports_) return;
  reports_->stop();
  sent_ += reports_->counts().sent;
  reports_.reset();
}

}  // namespace nearfit::test
