#include "device/falcon/falcon_device.h"

#include <functional>
#include <utility>
#include <vector>

#include "device/falcon/falcon_firmware.h"
#include "device/falcon/falcon_kinematics.h"
#include "device/interface/device_error.h"

namespace nearfit {
namespace {

constexpr std::uint8_t kInterface = 0;
constexpr std::uint8_t kVendorOut = 0x40;
constexpr UsbLink::Timeout kTimeout{1000};

/// The maker states about 9 N for short periods; damping and mass are cautious estimates.
DeviceLimits limits() noexcept {
  DeviceLimits limits;
  limits.maxForce = 9.0;
  limits.maxTorque = 0.0;
  limitSlewByMax(limits);
  limits.damping = 0.5;
  limits.leastMass = 0.15;
  return limits;
}

/// Checks for cancellation before each step of a greeting, since each may wait for a silent device.
class LinkTransport final : public falcon::FtdiTransport {
 public:
  LinkTransport(UsbLink& link, std::uint8_t in, std::uint8_t out, const std::function<bool()>& isWanted)
      : link_(link), in_(in), out_(out), isWanted_(isWanted) {}

  void control(std::uint8_t request, std::uint16_t value) override {
    requireWanted();
    link_.controlOut(kVendorOut, request, value, kInterface, {}, kTimeout);
  }
  void write(std::span<const std::byte> data) override { link_.write(out_, data, kTimeout); }
  std::size_t read(std::span<std::byte> packet, Timeout timeout) override try {
    requireWanted();
    return link_.read(in_, packet, timeout);
  } catch (const DeviceError& error) {
    if (error.cause() != DeviceProblem::NotAnswering) throw;
    return 0;
  }

 private:
  void requireWanted() const {
    if (!isWanted_()) throw Cancelled();
  }

  UsbLink& link_;
  const std::uint8_t in_, out_;
  const std::function<bool()>& isWanted_;
};

const UsbInterface* interfaceOf(const UsbDescription& device) noexcept {
  const UsbInterface* face = device.findInterface(kInterface);
  const bool isWhole =
      face != nullptr && face->streaming(true) != nullptr && face->streaming(false) != nullptr;
  return isWhole ? face : nullptr;
}

}  // namespace

bool FalconDevice::speaks(const UsbDescription& device) noexcept {
  return device.vendor == falcon::kVendor && device.product == falcon::kProduct &&
         interfaceOf(device) != nullptr;
}

FalconDevice::FalconDevice(UsbDescription device, std::filesystem::path firmware, const SafetyLimits& safety)
    : ForceArmDevice(std::move(device), "Novint Falcon", limits(), safety, 3),
      firmware_(std::move(firmware)) {}

std::string FalconDevice::stateNote() const {
  return stream().note("the position of its handle is not known: pull it all the way out, then push it in");
}

ForceArmDevice::Opened FalconDevice::open(std::optional<UsbLink>& link, const ProgressCallback& progress) {
  const UsbInterface* face = interfaceOf(description());
  if (face == nullptr) {
    throw DeviceError(DeviceProblem::Unsupported, name(), "its interface lacks the expected endpoints",
                      "plug it in again");
  }
  link.emplace(description(), kInterface);
  const std::uint8_t in = face->streaming(true)->address, out = face->streaming(false)->address;
  double fraction = 0.0;
  const ProgressCallback tell = [&](double done) { return !progress || progress(fraction = done); };
  const std::function<bool()> isWanted = [&] { return tell(fraction); };
  LinkTransport transport(*link, in, out, isWanted);
  falcon::FtdiPort port(transport);
  if (!falcon::isFirmwareRunning(port))
    falcon::uploadFirmware(port, falcon::readFirmware(firmware_, name()), name(), tell);
  port.purge();
  reader_ = {};
  isHomed_ = false;
  last_ = falcon::kCentre;
  velocity_.reset();
  ArmSample rest;
  rest.pose.translation = falcon::kCentre;
  rest.joints = falcon::inverse(falcon::kCentre).value_or(glm::dvec3(0.0));
  return {{in, out}, false, rest, 1e-3};
}

void FalconDevice::take(std::span<const std::byte> packet, Nanoseconds arrived) noexcept {
  const std::uint64_t damagedBefore = reader_.damaged();
  // Packets that carry only the chip's status arrive all the time.
  for (const std::byte byte : falcon::FtdiPort::contentOf(packet)) {
    if (const auto report = reader_.take(byte)) take(*report, arrived);
  }
  for (std::uint64_t i = damagedBefore; i < reader_.damaged(); ++i)
    stream().reject();
}

void FalconDevice::take(const falcon::Report& report, Nanoseconds arrived) noexcept {
  ArmSample& sample = stream().next();
  sample = {};
  sample.pose.translation = last_;
  sample.buttons = report.buttons;
  const bool wasHomed = std::exchange(isHomed_, report.homed == falcon::kAllHomed);
  if (isHomed_) {
    sample.joints = falcon::anglesOf(report.encoders);
    // A letter damaged in transit looks like this too; more than a few in a row are no accident.
    const auto place =
        falcon::isInRange(sample.joints) ? falcon::forward(sample.joints, last_) : std::nullopt;
    if (!place) return stream().reject(DeviceFault::OutOfReach);
    sample.pose.translation = last_ = *place;
    if (!wasHomed) velocity_.reset();
    sample.velocity = velocity_.update(last_, arrived);
    stream().supervisor().calibrated();
  } else if (wasHomed) {
    // The device has forgotten where its handle is.
    stream().supervisor().stop(DeviceFault::OutOfReach);
  }
  stream().publish(arrived);
}

std::span<const std::byte> FalconDevice::command(const glm::dvec3& force, const ArmSample& at) noexcept {
  const DeviceState is = state();
  falcon::Command command;
  if (is == DeviceState::Armed) command.torques = falcon::unitsFor(force, at.pose.translation, at.joints);
  command.isHoming = is == DeviceState::Uncalibrated;
  command.lights = is == DeviceState::Armed   ? falcon::kBlue
                   : is == DeviceState::Ready ? falcon::kGreen
                                              : falcon::kRed;
  command_ = falcon::encode(command);
  return command_;
}

}  // namespace nearfit
