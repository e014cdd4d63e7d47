#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/device_error.h"
#include "device/device_registry.h"
#include "device/plugin/device_plugin.h"
#include "device/usb/usb_bus.h"

namespace nearfit {

/// A device that is plugged in and that Nearfit knows: on USB, or through a plug-in.
struct DeviceListing {
  std::string
      driver;         ///< Short: "openhap", "spacemouse", "falcon", "polhem", "plugin"; "none" for no driver.
  std::string name;   ///< As it calls itself, or else as its kind is called.
  std::string kind;   ///< What it does, as a phrase.
  std::string needs;  ///< What it waits for once it is open; or empty.
  std::string place;  ///< "1-4.2": where it is plugged in; of plug-ins' devices, the plug-in and a number.
  std::string id;     ///< "046d:c626"; or its serial number.
  std::string kernelDriver;              ///< That gives it up when it is opened; or empty.
  std::optional<DeviceProblem> problem;  ///< None: it can be used.
  std::string reason, remedy;            ///< Why not, as of an Error.
  std::string command;                   ///< One line for a shell that mends it; or empty.

  UsbDescription usb;  ///< Of those on USB.
  std::shared_ptr<const DevicePlugin> plugin;
  std::int32_t index = 0;  ///< In the plug-in.
  NearfitDeviceDescription description{};

  bool isUsable() const noexcept { return !problem; }
  /// The same one, not plugged in again since.
  bool isSamePlugging(const DeviceListing& other) const noexcept;
};

/// Those of plug-ins alone, for machines without USB. @param problems  Takes what went wrong, a sentence
/// each.
std::vector<DeviceListing> listPluginDevices(const PluginSearch& plugins, std::vector<std::string>& problems);

/// What is plugged in: on the bus, by number and address, then of the plug-ins. Opens nothing for longer than
/// a look. Throws DeviceError.
/// @param problems  Takes what went wrong with plug-ins, a sentence each.
std::vector<DeviceListing> listDevices(const UsbBus& bus, const PluginSearch& plugins,
                                       std::vector<std::string>& problems);

/// The first that can be used, of those that `wanted` means: a driver ("openhap"), an id, a place, a node of
/// /dev, or a part of its name, upper or lower case; empty for any. Throws DeviceError that says which there
/// are, or why the one that is meant cannot be used.
const DeviceListing& chooseDevice(const std::vector<DeviceListing>& devices, std::string_view wanted);

/// Nothing is opened yet. Throws as makeDevice of the registry does.
std::unique_ptr<HapticDevice> makeDevice(const DeviceListing& device, const DeviceFiles& files);

}  // namespace nearfit
