#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/haptic_device.h"
#include "device/usb/usb_description.h"

namespace nearfit {

/// Which of our drivers takes a device.
enum class DeviceDriver : std::uint8_t {
  None,  ///< It is known, and none does.
  OpenHap,
  Polhem,
  Falcon,
  SpaceMouse,
};

/// What is known of a device before it is opened.
struct DeviceMatch {
  DeviceDriver driver = DeviceDriver::None;
  std::string name;  ///< Of the kind: "Novint Falcon".
  std::string kind;  ///< What it does, as a phrase: "feels 3 axes, pushes along 3".
  std::string
      needs;  ///< What it needs, or why it cannot be used, as a sentence without a full stop; may be empty.
  std::string remedy = {};  ///< Of what cannot be used; may be empty.

  bool isUsable() const noexcept { return driver != DeviceDriver::None; }
};

/// Nothing for devices that have nothing to do with touch: keyboards, hubs. One that a driver takes as a rule
/// and not this time (another version, a mouse of a maker of space mice) is known and not usable.
std::optional<DeviceMatch> recognise(const UsbDescription& device);

/// Of the kinds of devices that there are drivers for.
std::vector<std::string> drivenKinds();

/// For makers whose devices carry numbers of the chips in them: by what a device calls itself and its maker.
std::optional<DeviceMatch> recogniseByName(std::string_view makerAndProduct);

/// Files of the user's that drivers need.
struct DeviceFiles {
  std::filesystem::path falconFirmware;     ///< Of a Novint Falcon; may be empty as long as it is loaded.
  std::filesystem::path polhemCalibration;  ///< Empty: the WoodenHaptics as published.
};

/// A driver for the device; nothing is opened yet. Throws DeviceError for what recognise() does not find
/// usable, saying why; FileError for a calibration that is wrong.
std::unique_ptr<HapticDevice> makeDevice(const UsbDescription& device, const DeviceFiles& files);

}  // namespace nearfit
