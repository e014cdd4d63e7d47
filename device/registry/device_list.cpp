#include "device/registry/device_list.h"

#include <algorithm>
#include <cctype>

#include "device/usb/usb_access.h"

namespace nearfit {
namespace {

const char* wordOf(DeviceDriver driver) noexcept {
  switch (driver) {
    case DeviceDriver::None:
      return "none";
    case DeviceDriver::OpenHap:
      return "openhap";
    case DeviceDriver::Polhem:
      return "polhem";
    case DeviceDriver::Falcon:
      return "falcon";
    case DeviceDriver::SpaceMouse:
      return "spacemouse";
  }
  return "none";
}

/// Adds the command that grants permission. Without a rules file the remedy stays in words.
void addCommand(DeviceListing& listing) {
  try {
    listing.command = udevCommand();
    listing.remedy = "run: " + listing.command;
  } catch (const FileError&) {
  }
}

DeviceListing listingOf(const UsbDescription& usb, const DeviceMatch& match) {
  DeviceListing listing;
  listing.driver = wordOf(match.driver);
  listing.name = usbProductName(usb);
  if (listing.name.empty()) listing.name = match.name;
  listing.kind = match.kind;
  listing.place = usb.place();
  listing.id = usb.id();
  listing.usb = usb;
  if (!match.isUsable()) {
    listing.problem = DeviceProblem::Unsupported;
    listing.reason = match.needs;
    listing.remedy = match.remedy;
    return listing;
  }
  listing.needs = match.needs;
  UsbAccess access = usbAccess(usb);
  listing.problem = access.problem;
  listing.reason = std::move(access.reason);
  listing.remedy = std::move(access.remedy);
  listing.kernelDriver = std::move(access.kernelDriver);
  if (listing.problem == DeviceProblem::NoPermission) addCommand(listing);
  return listing;
}

std::string kindOf(const NearfitDeviceDescription& device) {
  const std::string senses = "senses " + std::to_string(device.sensed_axes) + " axes, ";
  if (device.force_axes == 0) return senses + "does not push";
  const bool isUnfelt = device.sensed_axes == 6 && device.force_axes == 3;
  return senses + "pushes along " + std::to_string(device.force_axes) +
         (isUnfelt ? ", torque is not felt" : "");
}

void addDevicesOf(const std::shared_ptr<const DevicePlugin>& plugin, std::vector<DeviceListing>& devices) {
  std::int32_t index = 0;
  for (const NearfitDeviceDescription& each : plugin->devices()) {
    DeviceListing& listing = devices.emplace_back();
    listing.driver = "plugin";
    listing.name = each.name;
    listing.kind = kindOf(each);
    listing.place = plugin->file().stem().string() + ":" + std::to_string(index + 1);
    listing.id = each.serial;
    listing.plugin = plugin;
    listing.index = index++;
    listing.description = each;
  }
}

std::string lowered(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool isMeant(const DeviceListing& device, const std::string& wanted) {
  return wanted.empty() || wanted == device.driver || wanted == lowered(device.id) ||
         wanted == lowered(device.place) || (!device.plugin && wanted == device.usb.node()) ||
         lowered(device.name).find(wanted) != std::string::npos;
}

std::string namesOf(const std::vector<DeviceListing>& devices) {
  std::string names;
  for (const DeviceListing& each : devices)
    names += (names.empty() ? "" : ", ") + each.name + " (" + each.driver + " at " + each.place + ")";
  return names;
}

}  // namespace

bool DeviceListing::isSamePlugging(const DeviceListing& other) const noexcept {
  if (plugin || other.plugin) return plugin == other.plugin && place == other.place && id == other.id;
  return usb.isSamePlugging(other.usb);
}

std::vector<DeviceListing> listPluginDevices(const PluginSearch& plugins, std::vector<std::string>& problems,
                                             std::vector<MissingDriver>* missing) {
  std::vector<DeviceListing> devices;
  problems = plugins.problems;
  if (missing != nullptr) missing->clear();
  for (const std::shared_ptr<const DevicePlugin>& plugin : plugins.plugins) {
    try {
      addDevicesOf(plugin, devices);
    } catch (const DeviceError& error) {
      if (error.cause() != DeviceProblem::NoDriver)
        problems.emplace_back(error.what());
      else if (missing != nullptr)
        missing->push_back({plugin->name(), error.remedy()});
    }
  }
  return devices;
}

std::vector<DeviceListing> listDevices(const UsbBus& bus, const PluginSearch& plugins,
                                       std::vector<std::string>& problems,
                                       std::vector<MissingDriver>* missing) {
  std::vector<DeviceListing> devices;
  for (const UsbDescription& usb : bus.list()) {
    std::optional<DeviceMatch> match = recognise(usb);
    if (!match) match = recogniseByName(usbMakerName(usb) + ' ' + usbProductName(usb));
    if (match) devices.push_back(listingOf(usb, *match));
  }
  for (DeviceListing& each : listPluginDevices(plugins, problems, missing))
    devices.push_back(std::move(each));
  return devices;
}

const DeviceListing& chooseDevice(const std::vector<DeviceListing>& devices, std::string_view wanted) {
  const std::string text = lowered(wanted);
  const DeviceListing* unusable = nullptr;
  for (const DeviceListing& each : devices) {
    if (!isMeant(each, text)) continue;
    if (each.isUsable()) return each;
    if (unusable == nullptr) unusable = &each;
  }
  if (unusable != nullptr) {
    throw DeviceError(*unusable->problem, unusable->name + " at " + unusable->place, unusable->reason,
                      unusable->remedy);
  }
  if (devices.empty()) {
    throw DeviceError(DeviceProblem::Gone, "devices", "no supported device is plugged in",
                      "plug one in; nearfit-cli devices lists them");
  }
  throw DeviceError(DeviceProblem::Gone, "device \"" + std::string(wanted) + "\"", "it is not plugged in",
                    "choose one that is plugged in: " + namesOf(devices));
}

std::unique_ptr<HapticDevice> makeDevice(const DeviceListing& device, const DeviceFiles& files) {
  if (device.plugin) return makePluginDevice(device.plugin, device.index, device.description);
  return makeDevice(device.usb, files);
}

}  // namespace nearfit
