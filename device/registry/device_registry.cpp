#include "device/registry/device_registry.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "device/falcon/falcon_device.h"
#include "device/interface/device_error.h"
#include "device/openhap/openhap_device.h"
#include "device/polhem/polhem_device.h"
#include "device/spacemouse/spacemouse_device.h"

namespace nearfit {
namespace {

using Made = std::unique_ptr<HapticDevice>;

struct Driver {
  DeviceDriver driver;
  const char *name, *kind, *needs;
  bool (*speaks)(const UsbDescription&) noexcept;
  Made (*make)(const UsbDescription&, const DeviceFiles&);
  /// Returns why this device is refused; null if the driver refuses none.
  std::optional<DeviceRefusal> (*refusal)(const UsbDescription&) = nullptr;
};

Made makePolhem(const UsbDescription& device, const DeviceFiles& files) {
  const std::filesystem::path& file = files.polhemCalibration;
  return std::make_unique<PolhemDevice>(device,
                                        file.empty() ? polhem::Calibration{} : polhem::readCalibration(file));
}

/// The first driver that accepts a device gets it. A new driver is one more row here.
constexpr std::array kDrivers = {
    Driver{DeviceDriver::OpenHap, "OpenHap device", "senses 6 axes, pushes along 3 or 6", "",
           &OpenHapDevice::speaks,
           [](const UsbDescription& device, const DeviceFiles&) -> Made {
             return std::make_unique<OpenHapDevice>(device);
           },
           &OpenHapDevice::refusal},
    Driver{DeviceDriver::SpaceMouse, "3Dconnexion SpaceMouse", "senses 6 axes, does not push", "",
           &SpaceMouseDevice::speaks,
           [](const UsbDescription& device, const DeviceFiles&) -> Made {
             return std::make_unique<SpaceMouseDevice>(device);
           },
           &SpaceMouseDevice::refusal},
    Driver{DeviceDriver::Falcon, "Novint Falcon", "senses 3 axes, pushes along 3",
           "its maker's firmware file each time that it is switched on, and its handle moved out and in",
           &FalconDevice::speaks,
           [](const UsbDescription& device, const DeviceFiles& files) -> Made {
             return std::make_unique<FalconDevice>(device, files.falconFirmware);
           }},
    Driver{DeviceDriver::Polhem, "WoodenHaptics or Polhem", "senses 3 or 6 axes, pushes along 3",
           "its calibration file, and its handle held in its rest after it is plugged in",
           &PolhemDevice::speaks, &makePolhem}};

constexpr std::uint16_t kAnyProduct = 0;

/// Devices that people own and Nearfit cannot drive.
struct Foreign {
  std::uint16_t vendor, product;
  const char *name, *kind, *why;
};
constexpr const char* kSeeDocument = "see resources/docs/devices.md";
constexpr const char* kPlugin =
    "its protocol is proprietary: it is driven through its maker's software, and is listed a second time "
    "once that "
    "is installed";
constexpr std::array kForeign = {
    Foreign{0x1451, kAnyProduct, "Force Dimension haptic device", "senses 3 to 7 axes, pushes along 3 to 7",
            kPlugin},
    Foreign{0x2988, kAnyProduct, "3D Systems Touch", "senses 6 axes, pushes along 3", kPlugin},
    // The first models with USB have vendor and product swapped.
    Foreign{0x0301, 0x2988, "3D Systems Touch", "senses 6 axes, pushes along 3", kPlugin},
    // Haply builds it in, under the ID that every Teensy has.
    Foreign{polhem::kTeensyVendor, 0x0483, "Teensy, if it is in a Haply Inverse3",
            "senses 3 axes, pushes along 3",
            "if it is in a Haply Inverse3, it is driven through its maker's software, and is listed a second "
            "time "
            "once that runs; any other Teensy is not supported"},
    Foreign{0x1532, 0x0300, "Razer Hydra", "senses 6 axes with each hand, does not push",
            "there is no driver for it"}};

const Driver* driverFor(const UsbDescription& device) noexcept {
  const auto found =
      std::find_if(kDrivers.begin(), kDrivers.end(), [&](const Driver& each) { return each.speaks(device); });
  return found == kDrivers.end() ? nullptr : &*found;
}

std::optional<DeviceRefusal> refusalOf(const Driver& driver, const UsbDescription& device) {
  return driver.refusal == nullptr ? std::nullopt : driver.refusal(device);
}

/// Whatever is built from a Teensy keeps the Teensy's ID.
bool isAnyTeensy(const UsbDescription& device) noexcept {
  return device.vendor == polhem::kTeensyVendor && device.product == polhem::kTeensyProduct;
}

}  // namespace

std::optional<DeviceMatch> recognise(const UsbDescription& device) {
  if (const Driver* driver = driverFor(device)) {
    if (const std::optional<DeviceRefusal> refusal = refusalOf(*driver, device))
      return DeviceMatch{DeviceDriver::None, driver->name, driver->kind, refusal->reason, refusal->remedy};
    DeviceMatch match{driver->driver, driver->name, driver->kind, driver->needs};
    if (isAnyTeensy(device)) match.name = "Teensy, if it is in a " + match.name;
    return match;
  }
  for (const Foreign& each : kForeign) {
    if (device.vendor == each.vendor && (each.product == kAnyProduct || device.product == each.product))
      return DeviceMatch{DeviceDriver::None, each.name, each.kind, each.why, kSeeDocument};
  }
  return std::nullopt;
}

std::vector<std::string> drivenKinds() {
  std::vector<std::string> kinds;
  for (const Driver& driver : kDrivers)
    kinds.emplace_back(driver.name);
  return kinds;
}

std::optional<DeviceMatch> recogniseByName(std::string_view makerAndProduct) {
  std::string name(makerAndProduct);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* haply : {"haply", "inverse3", "versegrip"}) {
    if (name.find(haply) != std::string::npos)
      return DeviceMatch{DeviceDriver::None, "Haply device", "senses 3 or 6 axes, pushes along 3", kPlugin,
                         kSeeDocument};
  }
  return std::nullopt;
}

std::unique_ptr<HapticDevice> makeDevice(const UsbDescription& device, const DeviceFiles& files) {
  const Driver* driver = driverFor(device);
  if (driver != nullptr && !refusalOf(*driver, device)) return driver->make(device, files);
  const std::string where = "USB device " + device.id() + " at " + device.node();
  const std::optional<DeviceMatch> match = recognise(device);
  if (!match) {
    throw DeviceError(DeviceProblem::Unsupported, where, "it is not a supported haptic device",
                      "choose another device");
  }
  throw DeviceError(
      DeviceProblem::Unsupported, match->name + " (" + device.id() + ")", match->needs,
      match->remedy.empty() ? "nearfit-cli devices lists those that can be used" : match->remedy);
}

}  // namespace nearfit
