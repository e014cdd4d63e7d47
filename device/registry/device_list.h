#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/interface/device_error.h"
#include "device/plugin/device_plugin.h"
#include "device/registry/device_registry.h"
#include "device/usb/usb_bus.h"

namespace nearfit {

/// A known device that is plugged in, over USB or through a plug-in.
struct DeviceListing {
  /// Short name: "openhap", "spacemouse", "falcon", "polhem", "plugin"; "none" without a driver.
  std::string driver;
  std::string name;   ///< Name that the device reports, else that of its kind.
  std::string kind;   ///< Abilities as a phrase.
  std::string needs;  ///< Needs that remain once it is open; may be empty.
  /// Where it is plugged in: bus and ports ("1-4.2"), or plug-in and number ("name:1").
  std::string place;
  std::string id;                        ///< USB ID ("046d:c626"), or a plug-in device's serial number.
  std::string kernelDriver;              ///< Kernel driver that opening detaches; may be empty.
  std::optional<DeviceProblem> problem;  ///< Why it cannot be used; empty if it can.
  std::string reason, remedy;            ///< Explain `problem`, worded as in an Error.
  std::string command;                   ///< One-line shell command that fixes it; may be empty.

  UsbDescription usb;                          ///< USB devices only.
  std::shared_ptr<const DevicePlugin> plugin;  ///< Null for USB devices.
  std::int32_t index = 0;                      ///< Index within `plugin`.
  NearfitDeviceDescription description{};      ///< Given by the plug-in.

  bool isUsable() const noexcept { return !problem; }
  /// True if `other` is the same device and it has not been replugged since.
  bool isSamePlugging(const DeviceListing& other) const noexcept;
};

/// Devices that need a maker's driver which is not there.
struct MissingDriver {
  std::string name;    ///< Of the plug-in that would drive them.
  std::string remedy;  ///< What to install, in one line.
};

/// Lists the devices of plug-ins alone, for machines without USB. Asks each plug-in once: it may take a while.
/// @param problems  Receives a sentence for each failure; earlier content is discarded.
/// @param missing   If not null, receives the plug-ins that cannot do without what their makers give out, and do not
///                  find it; earlier content is discarded. That is no problem unless somebody has such a device.
std::vector<DeviceListing> listPluginDevices(const PluginSearch& plugins, std::vector<std::string>& problems,
                                             std::vector<MissingDriver>* missing = nullptr);

/// Lists the known devices that are plugged in: USB devices by bus and address, then those of plug-ins. Opens
/// device nodes only for a moment. Throws DeviceError if USB cannot be listed.
/// @param problems  Receives a sentence for each failure of a plug-in; earlier content is discarded.
/// @param missing   As for listPluginDevices().
std::vector<DeviceListing> listDevices(const UsbBus& bus, const PluginSearch& plugins,
                                       std::vector<std::string>& problems,
                                       std::vector<MissingDriver>* missing = nullptr);

/// Returns the first usable device that matches `wanted`: a driver ("openhap"), an ID, a place, a node in
/// /dev or a part of the name, in upper or lower case; empty matches any. Throws DeviceError that lists the
/// devices, or says why the match cannot be used.
const DeviceListing& chooseDevice(const std::vector<DeviceListing>& devices, std::string_view wanted);

/// Creates the driver for a device; opens nothing yet. Throws as makeDevice() of the registry does.
std::unique_ptr<HapticDevice> makeDevice(const DeviceListing& device, const DeviceFiles& files);

}  // namespace nearfit
