#include "tests/usb/spacemouse_emulator.h"

#include <utility>

namespace nearfit::test {
namespace {

EmulatedDescription descriptionOf(SpaceMouseFirmware::Model model, const SpaceMouseFirmware& firmware) {
  const bool isNavigator = model == SpaceMouseFirmware::Model::Navigator;
  EmulatedDescription description;
  description.vendor = 0x046d;
  description.product = isNavigator ? 0xc626 : 0xc62b;
  description.manufacturer = "3Dconnexion";
  description.productName = isNavigator ? "SpaceNavigator" : "SpaceMouse Pro";
  description.speed = 12;
  description.interfaces = {{.classCode = 3,
                             .endpoints = {{.address = 0x81,
                                            .maxPacket = static_cast<std::uint16_t>(isNavigator ? 7 : 13),
                                            .interval = 8}},
                             .reportDescriptor = firmware.descriptor(),
                             .kernelDriver = "usbhid"}};
  return description;
}

}  // namespace

SpaceMouseEmulator::SpaceMouseEmulator(SpaceMouseFirmware::Model model)
    : firmware_(model), device_(std::make_shared<EmulatedDevice>(descriptionOf(model, firmware_))) {
  device_->onControl = [this](const ControlRequest& request) -> std::optional<Bytes> {
    const std::lock_guard lock(mutex_);
    return firmware_.onRequest(request.type, request.request, request.value, bytesOf(request.data));
  };
}

void SpaceMouseEmulator::stream(std::function<void(SpaceMouseFirmware&, double)> hand, double rate) {
  stopStreaming();
  const std::size_t perMoment = withFirmware([](const auto& firmware) { return firmware.reports().size(); });
  ReportStream::Plan plan;
  plan.rate = rate * static_cast<double>(perMoment);
  plan.isPatient = true;
  plan.report = [this, perMoment, rate, hand = std::move(hand)](std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    const std::uint64_t moment = number / perMoment;
    if (number % perMoment == 0) hand(firmware_, static_cast<double>(moment) / rate);
    return firmware_.reports().at(number % perMoment);
  };
  reports_.emplace(*device_, std::move(plan));
}

void SpaceMouseEmulator::stopStreaming() {
  if (reports_) reports_->stop();
}

}  // namespace nearfit::test
