#include "tests/usb/usb_fixture.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace nearfit::test {

EmulatedDescription plainDescription() {
  EmulatedDescription description;
  description.interfaces = {{.endpoints = {{.address = kIn}, {.address = kOut}}}};
  return description;
}

std::shared_ptr<EmulatedDevice> plainDevice() {
  return std::make_shared<EmulatedDevice>(plainDescription());
}

Bytes numbered(std::uint64_t number, std::size_t size) {
  Bytes bytes(size);
  if (size > 0) std::memcpy(bytes.data(), &number, std::min(size, sizeof number));
  return bytes;
}

std::uint64_t numberIn(std::span<const std::byte> packet) {
  std::uint64_t number = 0;
  if (!packet.empty()) std::memcpy(&number, packet.data(), std::min(packet.size(), sizeof number));
  return number;
}

void RecordingSink::onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept {
  if (onEach) onEach(packet);
  const std::lock_guard lock(mutex_);
  packets_.push_back(bytesOf(packet));
  arrivals_.push_back(arrived);
}

void RecordingSink::onLost(UsbLoss loss) noexcept {
  const std::lock_guard lock(mutex_);
  losses_.push_back(loss);
}

std::vector<Bytes> RecordingSink::packets() const {
  const std::lock_guard lock(mutex_);
  return packets_;
}

std::size_t RecordingSink::count() const {
  const std::lock_guard lock(mutex_);
  return packets_.size();
}

std::vector<std::int64_t> RecordingSink::arrivals() const {
  const std::lock_guard lock(mutex_);
  return arrivals_;
}

std::vector<UsbLoss> RecordingSink::losses() const {
  const std::lock_guard lock(mutex_);
  return losses_;
}

UsbLinkTest::UsbLinkTest() {
  bus.plug(device);
}

std::vector<UsbDescription> UsbLinkTest::seenAll() {
  return UsbBus().list();
}

UsbDescription UsbLinkTest::seen(unsigned port) {
  for (const UsbDescription& each : seenAll()) {
    if (!each.ports.empty() && each.ports.back() == port) return each;
  }
  throw std::runtime_error("nothing is seen in that port");
}

}  // namespace nearfit::test
