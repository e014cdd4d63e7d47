#include "tests/usb/openhap_emulator.h"

#include <utility>

namespace nearfit::test {
namespace {

constexpr std::uint8_t kPoseEndpoint = 0x81, kWrenchEndpoint = 0x01;

EmulatedDescription descriptionOf() {
  EmulatedDescription description;
  description.product = 0x0048;
  description.manufacturer = "Nearfit";
  description.productName = "OpenHap emulator";
  description.interfaces = {{.classCode = openhap::kInterfaceClass,
                             .subclass = openhap::kInterfaceSubclass,
                             .protocol = openhap::kMajorVersion,
                             .endpoints = {{.address = kPoseEndpoint}, {.address = kWrenchEndpoint}}}};
  return description;
}

}  // namespace

openhap::Capabilities OpenHapEmulator::usualCapabilities() {
  openhap::Capabilities is;
  is.buttonCount = 2;
  is.rate = 1000;
  is.watchdogMs = 50;
  is.maxForce = 8.0F;
  is.maxTorque = 0.5F;
  is.damping = 0.5F;
  is.rotationalDamping = 0.002F;
  is.mass = 0.1F;
  is.inertia = 5e-5F;
  is.workspace = {0.1F, 0.1F, 0.1F};
  is.maxSpeed = 2.0F;
  return is;
}

OpenHapEmulator::OpenHapEmulator(const openhap::Capabilities& capabilities)
    : capabilities_(capabilities),
      firmware_(capabilities),
      device_(std::make_shared<EmulatedDevice>(descriptionOf())) {
  device_->onControl = [this](const ControlRequest& request) -> std::optional<Bytes> {
    const std::lock_guard lock(mutex_);
    firmware_.onTime(now());
    return firmware_.onRequest(request.type, request.request);
  };
  device_->onPacket = [this](std::uint8_t, std::span<const std::byte> packet) { onWrench(packet); };
}

OpenHapFirmware::Rendered OpenHapEmulator::rendered() {
  const std::lock_guard lock(mutex_);
  firmware_.onTime(now());
  return firmware_.rendered();
}

void OpenHapEmulator::stream(Motion motion) {
  stopStreaming();
  {
    const std::lock_guard lock(mutex_);
    streamStart_ = now();
    roundTrips_.clear();
  }
  ReportStream::Plan plan;
  plan.endpoint = kPoseEndpoint;
  plan.rate = motion.rate > 0.0 ? motion.rate : capabilities_.rate;
  plan.count = motion.count;
  plan.isPatient = motion.count == 0;
  if (motion.waitsForAnswers) {
    plan.mayGo = [this](std::uint64_t number) {
      const std::lock_guard lock(mutex_);
      return number == 0 || lastAnswered_ == lastSent_;
    };
  }
  plan.report = [this, motion = std::move(motion)](std::uint64_t number) { return pose(motion, number); };
  reports_.emplace(*device_, std::move(plan));
}

Bytes OpenHapEmulator::pose(const Motion& motion, std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  const double time = now();
  if (motion.hand) motion.hand(firmware_, time - streamStart_);
  const auto report = firmware_.poseReport(time);
  openhap::PoseReport sent;
  static_cast<void>(decode(std::span(report), sent));
  lastSent_ = sent.sequence;
  sentAt_.at(sent.sequence) = monotonicNow();
  Bytes bytes(report.begin(), report.end());
  if (motion.damage) motion.damage(bytes, number);
  return bytes;
}

void OpenHapEmulator::onWrench(std::span<const std::byte> packet) {
  const Nanoseconds arrived = monotonicNow();
  const std::lock_guard lock(mutex_);
  firmware_.onPacket(packet, now());
  openhap::WrenchReport wrench;
  if (decode(packet, wrench) != openhap::Reject::None) return;
  lastAnswered_ = wrench.sequence;
  // A wrench without a new pose answers the last one again.
  const Nanoseconds sent = std::exchange(sentAt_.at(wrench.sequence), 0);
  if (sent != 0) roundTrips_.record(toSeconds(arrived - sent));
}

void OpenHapEmulator::join() {
  if (reports_) reports_->join();
}

void OpenHapEmulator::stopStreaming() {
  if (reports_) reports_->stop();
}

ReportStream::Counts OpenHapEmulator::counts() const {
  return reports_ ? reports_->counts() : ReportStream::Counts{};
}

LatencyHistogram OpenHapEmulator::roundTrips() const {
  const std::lock_guard lock(mutex_);
  return roundTrips_;
}

}  // namespace nearfit::test
