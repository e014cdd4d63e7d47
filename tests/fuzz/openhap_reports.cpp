// Packets of OpenHap, either way: what is taken is finite and comes back as the same bytes; the reference
// firmware renders within its limits whatever it is sent.
#include <algorithm>
#include <vector>

#include "device/openhap/openhap_protocol.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/usb/openhap_firmware.h"

namespace nearfit::fuzz {
namespace {

using namespace openhap;

/// Every other packet gets the right checksum: a fuzzer does not find those.
std::vector<std::byte> packetOf(ByteSource& source, std::size_t usual) {
  const bool isSealed = source.flag();
  const std::size_t size = source.flag() ? usual : source.below(80);
  std::vector<std::byte> packet(size);
  for (std::byte& byte : packet)
    byte = std::byte{source.byte()};
  if (isSealed && size >= 2) {
    const std::uint16_t crc = crc16(std::span(packet).first(size - 2));
    packet[size - 2] = static_cast<std::byte>(crc & 0xffU);
    packet[size - 1] = static_cast<std::byte>(crc >> 8U);
  }
  return packet;
}

template <class Report>
void checkRoundTrip(std::span<const std::byte> packet) {
  Report report;
  if (decode(packet, report) != Reject::None) {
    require(report == Report{}, "what is refused leaves no trace");
    return;
  }
  Report again;
  require(decode(encode(report), again) == Reject::None && again == report, "what is taken comes back");
}

void checkFirmware(ByteSource& source) {
  Capabilities capabilities;
  capabilities.maxForce = 5.0F;
  capabilities.maxTorque = 0.5F;
  capabilities.hasDeadMan = source.flag();
  test::OpenHapFirmware firmware(capabilities);
  firmware.isDeadManHeld = source.flag();
  double time = 0.0, lastArmed = -1.0;
  while (!source.isEmpty()) {
    time += 1e-3 * source.byte();
    if (source.flag()) {
      const std::uint8_t type = source.byte();
      firmware.onRequest(type, source.byte());
    }
    firmware.onPacket(packetOf(source, kWrenchSize), time);
    firmware.onTime(time);
    const test::OpenHapFirmware::Rendered rendered = firmware.rendered();
    const float force = std::hypot(rendered.force[0], rendered.force[1], rendered.force[2]);
    require(force <= 5.001F, "force is within its limit, and a number");
    if (firmware.isArmed()) lastArmed = time;
    if (time - lastArmed > test::OpenHapFirmware::kRampTime) require(force == 0.0F, "no force unless armed");
    PoseReport pose;
    require(decode(firmware.poseReport(time), pose) == Reject::None, "its reports are read");
  }
}

void run(std::span<const std::uint8_t> data) {
  ByteSource source(data.data(), data.size());
  switch (source.below(4)) {
    case 0:
      checkRoundTrip<PoseReport>(packetOf(source, kPoseSize));
      break;
    case 1:
      checkRoundTrip<WrenchReport>(packetOf(source, kWrenchSize));
      break;
    case 2:
      checkRoundTrip<Capabilities>(packetOf(source, kCapabilitiesSize));
      break;
    default:
      checkFirmware(source);
  }
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run({data, size});
  return 0;
}
