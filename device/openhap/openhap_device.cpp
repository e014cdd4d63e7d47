#include "device/openhap/openhap_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "device/interface/device_error.h"

namespace nearfit {
namespace {

using openhap::PoseStatus;

/// A wrench stays valid for a few periods of the device, and at least this long, to bridge a hiccup of this
/// machine. Then the device's watchdog takes over.
constexpr double kMinTimeToLive = 10e-3, kPeriodsToLive = 3.0;  // [s]
constexpr UsbLink::Timeout kRequestTimeout{500};
/// Holds the part while the hand repositions the device.
constexpr std::uint16_t kOpenHapClutchButton = 1;

std::uint16_t timeToLiveMs(std::uint16_t rate) noexcept {
  const double time = std::max(kMinTimeToLive, kPeriodsToLive / std::max<double>(rate, 1.0));
  return static_cast<std::uint16_t>(std::ceil(1e3 * time));
}

/// Returns the interface of our version, else one of another version; null if there is none.
const UsbInterface* openHapInterface(const UsbDescription& device) noexcept {
  const UsbInterface* found = nullptr;
  for (const UsbInterface& each : device.interfaces) {
    if (each.classCode != openhap::kInterfaceClass || each.subclass != openhap::kInterfaceSubclass) continue;
    if (each.protocol == openhap::kMajorVersion) return &each;
    if (found == nullptr) found = &each;
  }
  return found;
}

constexpr const char* kUpdate = "install a newer Nearfit or newer firmware";

std::string otherVersion(int version) {
  return fmt::format("it speaks version {} of OpenHap, but this program speaks version {}", version,
                     openhap::kMajorVersion);
}

glm::dvec3 vectorOf(const std::array<float, 3>& v) noexcept {
  return {v[0], v[1], v[2]};
}

std::array<float, 3> floatsOf(const glm::dvec3& v) noexcept {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

bool OpenHapDevice::speaks(const UsbDescription& device) noexcept {
  return openHapInterface(device) != nullptr;
}

std::optional<DeviceRefusal> OpenHapDevice::refusal(const UsbDescription& device) {
  const UsbInterface* face = openHapInterface(device);
  if (face == nullptr || face->protocol == openhap::kMajorVersion) return std::nullopt;
  return DeviceRefusal{otherVersion(face->protocol), kUpdate};
}

OpenHapDevice::OpenHapDevice(UsbDescription device, const SafetyLimits& limits)
    : device_(std::move(device)), safety_(limits) {}

OpenHapDevice::~OpenHapDevice() {
  stop();
}

std::string OpenHapDevice::name() const {
  return fmt::format("{} ({} at {})", product_.empty() ? "OpenHap device" : product_, device_.id(),
                     device_.node());
}

DeviceInfo OpenHapDevice::info() const {
  DeviceInfo info{name(), capabilities_.rendersTorque ? 6 : 3, DeviceLimits{}, 1.0 / capabilities_.rate};
  info.sensedAxes = capabilities_.sensesOrientation ? 6 : 3;
  DeviceLimits& limits = info.limits;
  limits.maxForce = capabilities_.maxForce;
  limits.maxTorque = capabilities_.rendersTorque ? capabilities_.maxTorque : 0.0;
  limitSlewByMax(limits);
  limits.damping = capabilities_.damping;
  limits.rotationalDamping = capabilities_.rotationalDamping;
  limits.leastMass = std::max<double>(limits.leastMass, capabilities_.mass);
  limits.leastInertia = std::max<double>(limits.leastInertia, capabilities_.inertia);
  return info;
}

std::string OpenHapDevice::stateNote() const {
  const std::string note = stream_.note("the position of its handle is not known: home it");
  if (state() != DeviceState::Fault || stream_.supervisor().fault() != DeviceFault::Reported) return note;
  const std::lock_guard lock(faultMutex_);
  return faultText_.empty() ? note : note + ": " + faultText_;
}

void OpenHapDevice::setFaultText(std::string text) {
  const std::lock_guard lock(faultMutex_);
  faultText_ = std::move(text);
}

void OpenHapDevice::askForFaultText() noexcept {
  link_->ask(openhap::kRequestIn, static_cast<std::uint8_t>(openhap::Request::FaultText), interfaceNumber_,
             openhap::kFaultTextSize, kRequestTimeout,
             [this](std::span<const std::byte> answer) { setFaultText(openhap::textOf(answer)); });
}

void OpenHapDevice::start(const RigidTransform&, const ProgressCallback&) {
  stop();
  stream_.supervisor().beginOpening();
  try {
    const UsbInterface* face = openHapInterface(device_);
    const UsbEndpoint* in = face == nullptr ? nullptr : face->streaming(true);
    const UsbEndpoint* out = face == nullptr ? nullptr : face->streaming(false);
    if (in == nullptr || out == nullptr || in->maxPacket < openhap::kPoseSize) {
      throw DeviceError(DeviceProblem::Unsupported, name(), "its interface lacks the endpoints of OpenHap",
                        "ask its maker for newer firmware");
    }
    interfaceNumber_ = face->number;
    link_.emplace(device_, face->number);
    product_ = link_->strings().product;
    capabilities_ = readCapabilities();
    request(openhap::Request::Disarm);
    hasSequence_ = hasPose_ = wasFaulted_ = false;
    setFaultText({});
    stream_.begin({});
    SafetyLimits limits = safety_;
    limits.hasDeadMan = capabilities_.hasDeadMan;
    limits.keepBelow(capabilities_.maxSpeed);
    limits.keepPace(1.0 / capabilities_.rate);
    stream_.supervisor().opened(limits, !capabilities_.needsHoming);
    link_->stream({in->address, out->address}, *this);
  } catch (...) {
    link_.reset();
    stream_.supervisor().closed(stateAfterFailure());
    throw;
  }
}

openhap::Capabilities OpenHapDevice::readCapabilities() {
  std::array<std::byte, openhap::kCapabilitiesSize> bytes{};
  const std::size_t count =
      link_->controlIn(openhap::kRequestIn, static_cast<std::uint8_t>(openhap::Request::Capabilities), 0,
                       interfaceNumber_, bytes, kRequestTimeout);
  openhap::Capabilities capabilities;
  const openhap::Reject reject = decode(std::span(bytes).first(count), capabilities);
  if (reject == openhap::Reject::Version) {
    throw DeviceError(DeviceProblem::Unsupported, name(), otherVersion(std::to_integer<int>(bytes[1])),
                      kUpdate);
  }
  if (reject != openhap::Reject::None) {
    throw DeviceError(DeviceProblem::NotAnswering, name(), "its description of itself cannot be read",
                      "plug it in again; if that does not help, ask its maker for newer firmware");
  }
  return capabilities;
}

void OpenHapDevice::request(openhap::Request request) {
  link_->controlOut(openhap::kRequestOut, static_cast<std::uint8_t>(request), 0, interfaceNumber_, {},
                    kRequestTimeout);
}

void OpenHapDevice::stop() noexcept {
  if (!link_) return;
  disarm();
  const bool isLost = state() == DeviceState::Lost;
  link_.reset();
  stream_.supervisor().closed(isLost ? DeviceState::Lost : DeviceState::Present);
}

void OpenHapDevice::arm() {
  stream_.supervisor().arm(name());
  try {
    request(openhap::Request::Arm);
  } catch (...) {
    stream_.supervisor().disarm();
    throw;
  }
}

void OpenHapDevice::calibrate() {
  stream_.supervisor().requireCalibratable(name());
  request(openhap::Request::Home);
}

void OpenHapDevice::reset() {
  if (state() != DeviceState::Fault) return;
  // Clears a tripped watchdog in the device.
  request(openhap::Request::Disarm);
  setFaultText({});
  stream_.supervisor().reset();
}

void OpenHapDevice::disarm() noexcept {
  stream_.supervisor().disarm();
  try {
    if (link_ && state() != DeviceState::Lost) request(openhap::Request::Disarm);
  } catch (const Error&) {
    // No force goes out any more, and the device's watchdog disarms it.
  }
}

void OpenHapDevice::onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept {
  openhap::PoseReport& report = stream_.next();
  if (decode(packet, report) != openhap::Reject::None) return stream_.reject();
  if (hasSequence_) {
    const auto step = static_cast<std::uint16_t>(report.sequence - lastSequence_);
    if (step > 1) stream_.countMissing(step - 1U);
  }
  hasSequence_ = true;
  lastSequence_ = report.sequence;
  const bool isFaulted = (report.status & (PoseStatus::kFaulted | PoseStatus::kWatchdogTripped)) != 0;
  if (isFaulted) stream_.supervisor().stop(DeviceFault::Reported);
  if (isFaulted && !wasFaulted_) askForFaultText();
  wasFaulted_ = isFaulted;
  if ((report.status & PoseStatus::kHomed) != 0) stream_.supervisor().calibrated();
  stream_.publish(arrived);
}

void OpenHapDevice::onLost(UsbLoss loss) noexcept {
  stream_.lose(loss);
}

bool OpenHapDevice::readHandle(HandleInput& handle) noexcept {
  if (!stream_.update()) return false;
  const openhap::PoseReport& report = stream_.report();
  const std::array<float, 4>& q = report.rotation;
  velocity_ = vectorOf(report.velocity);
  handle.pose = RigidTransform{{q[0], q[1], q[2], q[3]}, vectorOf(report.position)}.normalized();
  handle.age = stream_.age();
  handle.patience = stream_.supervisor().patience();
  // The part must not jump to wherever the handle is at first.
  handle.isClutched = !hasPose_ || (report.buttons & kOpenHapClutchButton) != 0;
  hasPose_ = stream_.hasReport();
  handle.hasOwnFrame = true;
  handle.isTorqueFelt = capabilities_.rendersTorque || !capabilities_.sensesOrientation;
  handle.buttons = report.buttons;
  handle.isArmed = stream_.supervisor().check(
      {handle.age, glm::length(velocity_), (report.status & PoseStatus::kDeadManHeld) != 0});
  return true;
}

void OpenHapDevice::sendWrench(const Wrench& wrench) noexcept {
  const Wrench guarded = stream_.supervisor().guarded(wrench, velocity_, capabilities_.maxForce);
  openhap::WrenchReport report;
  report.flags = state() == DeviceState::Armed ? openhap::kForcesOn : 0;
  report.sequence = stream_.report().sequence;
  report.force = floatsOf(guarded.force);
  report.torque = floatsOf(guarded.torque);
  report.timeToLiveMs = timeToLiveMs(capabilities_.rate);
  link_->send(encode(report));
}

}  // namespace nearfit
