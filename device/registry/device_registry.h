#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/interface/haptic_device.h"
#include "device/usb/usb_description.h"

namespace nearfit {

/// Built-in drivers.
enum class DeviceDriver : std::uint8_t {
  None,  ///< Known, but no driver can use it.
  OpenHap,
  Polhem,
  Falcon,
  SpaceMouse,
};

/// Knowledge of a device before it is opened.
struct DeviceMatch {
  DeviceDriver driver = DeviceDriver::None;
  std::string name;  ///< Name of the kind, such as "Novint Falcon".
  std::string kind;  ///< Abilities as a phrase: "feels 3 axes, pushes along 3".
  /// Its needs, or the reason why it cannot be used, as a sentence without a full stop; may be empty.
  std::string needs;
  std::string remedy = {};  ///< Way to make it usable; may be empty.

  bool isUsable() const noexcept { return driver != DeviceDriver::None; }
};

/// Recognises a device by its descriptors. Returns std::nullopt for devices that have nothing to do with
/// touch: keyboards, hubs. A device that its driver refuses (another version, a mouse from a maker of space
/// mice) is known but not usable.
std::optional<DeviceMatch> recognise(const UsbDescription& device);

/// Returns the names of all kinds that have a driver.
std::vector<std::string> drivenKinds();

/// Recognises, by maker's and product's names, devices that carry the USB ID of a chip inside them.
/// Ignores letter case.
/// @param makerAndProduct  Both names, separated by a space.
std::optional<DeviceMatch> recogniseByName(std::string_view makerAndProduct);

/// The user's files that drivers need.
struct DeviceFiles {
  std::filesystem::path falconFirmware;     ///< Firmware of a Falcon; may be empty while it is loaded.
  std::filesystem::path polhemCalibration;  ///< Empty: the WoodenHaptics as published.
};

/// Creates the driver for a device; opens nothing yet. Throws DeviceError with the reason if recognise()
/// finds the device unusable, FileError for an invalid calibration.
std::unique_ptr<HapticDevice> makeDevice(const UsbDescription& device, const DeviceFiles& files);

}  // namespace nearfit
