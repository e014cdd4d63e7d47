#include "device/polhem/polhem_device.h"

#include <algorithm>
#include <utility>

#include "device/interface/device_error.h"

namespace nearfit {
namespace {

constexpr std::uint8_t kHidClass = 3;
/// The firmware answers a command with a report; each way takes a USB frame [s].
constexpr double kMinPeriod = 1e-3;

bool isTeensy(const UsbDescription& device) noexcept {
  return device.vendor == polhem::kTeensyVendor && device.product == polhem::kTeensyProduct;
}

/// Returns the HID interface that takes commands. A Teensy has a second one, for text, with smaller packets.
const UsbInterface* polhemInterfaceOf(const UsbDescription& device) noexcept {
  const std::size_t size = isTeensy(device) ? polhem::kRawHidSize : polhem::kPacketSize;
  const auto found =
      std::find_if(device.interfaces.begin(), device.interfaces.end(), [&](const UsbInterface& each) {
        const UsbEndpoint* in = each.streaming(true);
        const UsbEndpoint* out = each.streaming(false);
        return each.classCode == kHidClass && in != nullptr && out != nullptr && in->maxPacket >= size &&
               out->maxPacket >= size;
      });
  return found == device.interfaces.end() ? nullptr : &*found;
}

}  // namespace

bool PolhemDevice::speaks(const UsbDescription& device) noexcept {
  const bool isKnown =
      (device.vendor == polhem::kVendor && device.product == polhem::kProduct) || isTeensy(device);
  return isKnown && polhemInterfaceOf(device) != nullptr;
}

PolhemDevice::PolhemDevice(UsbDescription device, const polhem::Calibration& calibration,
                           const SafetyLimits& safety)
    : ForceArmDevice(std::move(device), calibration.name, polhem::limitsOf(calibration), safety,
                     calibration.hasGimbal ? 6 : 3),
      calibration_(calibration),
      kinematics_(calibration) {}

std::string PolhemDevice::stateNote() const {
  return stream().note("the position of its handle is not known: hold it in its rest and calibrate it");
}

void PolhemDevice::calibrate() {
  stream().supervisor().requireCalibratable(name());
  isCalibrationDue_.store(true, std::memory_order_release);
}

ArmSample PolhemDevice::restSample() const noexcept {
  const polhem::Angles rest = kinematics_.restAngles();
  ArmSample sample;
  sample.joints = rest.arm;
  sample.pose = {kinematics_.orientationOf(rest), kinematics_.positionOf(rest.arm)};
  return sample;
}

ForceArmDevice::Opened PolhemDevice::open(std::optional<UsbLink>& link, const ProgressCallback&) {
  const UsbInterface* face = polhemInterfaceOf(description());
  if (face == nullptr) {
    throw DeviceError(DeviceProblem::Unsupported, name(), "its interface lacks the expected endpoints",
                      "install the firmware of WoodenHaptics or Polhem on it");
  }
  link.emplace(description(), face->number);
  packetSize_ = isTeensy(description()) ? polhem::kRawHidSize : polhem::kPacketSize;
  isCalibrationDue_.store(false, std::memory_order_release);
  velocity_.reset();
  hasReport_ = false;
  const UsbEndpoint* in = face->streaming(true);
  return {{in->address, face->streaming(false)->address},
          isCalibrated_,
          restSample(),
          std::max(kMinPeriod, in->interval)};
}

/// True if the rest pose is declared now. The button's flag stays set in the device, so a press before the
/// first report counts for nothing.
bool PolhemDevice::isRestShown(const polhem::Report& report) noexcept {
  const bool isPressedNow = hasReport_ && report.isButtonPressed && !wasButtonPressed_;
  hasReport_ = true;
  wasButtonPressed_ = report.isButtonPressed;
  const bool isAsked = isCalibrationDue_.exchange(false, std::memory_order_acq_rel);
  return (isAsked || isPressedNow) && (state() == DeviceState::Ready || state() == DeviceState::Uncalibrated);
}

void PolhemDevice::take(std::span<const std::byte> packet, Nanoseconds arrived) noexcept {
  const std::optional<polhem::Report> report = polhem::decode(packet);
  if (!report || packet.size() != packetSize_) return stream().reject();
  if (isRestShown(*report)) {
    rest_ = report->encoders;
    isCalibrated_ = true;
    velocity_.reset();
    stream().supervisor().calibrated();
  }
  ArmSample& sample = stream().next();
  sample = restSample();
  if (isCalibrated_) {
    const polhem::Angles angles = kinematics_.anglesOf(report->encoders, rest_);
    if (!kinematics_.isInRange(angles.arm)) {
      isCalibrated_ = false;
      stream().supervisor().stop(DeviceFault::OutOfReach);
    }
    sample.joints = angles.arm;
    sample.pose = {kinematics_.orientationOf(angles), kinematics_.positionOf(angles.arm)};
    sample.velocity = velocity_.update(sample.pose.translation, arrived);
  }
  stream().publish(arrived);
}

std::span<const std::byte> PolhemDevice::command(const glm::dvec3& force, const ArmSample& at) noexcept {
  command_ = polhem::encode(kinematics_.milliampsFor(force, at.joints));
  return std::span(command_).first(packetSize_);
}

}  // namespace nearfit
