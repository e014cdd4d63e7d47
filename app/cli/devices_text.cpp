#include "app/cli/devices_text.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/device_monitor.h"
#include "app/cli/output.h"

namespace nearfit::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Hands that need no hardware, and where to find them.
struct SimulatedHand {
  const char *id, *name, *use;
};
constexpr std::array kSimulatedHands = {
    SimulatedHand{"path", "Simulated hand on a path", "nearfit-cli place --path FILE"},
    SimulatedHand{"scripted", "Scripted hand", "the application, Feel panel"},
    SimulatedHand{"manual", "Mouse, numbers and arrow keys", "the application, Feel panel"}};

const char* problemName(DeviceProblem problem) {
  switch (problem) {
    case DeviceProblem::NoPermission:
      return "no_permission";
    case DeviceProblem::Busy:
      return "busy";
    case DeviceProblem::Gone:
      return "gone";
    case DeviceProblem::Unsupported:
      return "unsupported";
    case DeviceProblem::NoFirmware:
      return "no_firmware";
    case DeviceProblem::NoDriver:
      return "no_driver";
    case DeviceProblem::NotAnswering:
      return "not_answering";
    case DeviceProblem::Failed:
      return "failed";
  }
  return "failed";
}

std::string conditionText(const DeviceListing& device) {
  if (!device.isUsable())
    return "cannot be used: " + device.reason + (device.remedy.empty() ? "" : "; " + device.remedy);
  std::string text = "can be used";
  if (!device.needs.empty()) text += "; needs " + device.needs;
  if (!device.kernelDriver.empty()) text += "; " + device.kernelDriver + " gives it up while it is used";
  return text;
}

std::string listingLine(const DeviceListing& device) {
  return oneLine(fmt::format("{:<10}  {:<9}  {:<10}  {} ({}): {}", device.place, device.id, device.driver,
                             device.name, device.kind, conditionText(device)));
}

/// @param isThere  True if it is plugged in; false if it has just left.
Json listingJson(const DeviceListing& device, bool isThere = true) {
  Json json{{"place", device.place},
            {"state", stateName(isThere ? DeviceState::Present : DeviceState::Absent)},
            {"id", device.id},
            {"driver", device.driver},
            {"name", device.name},
            {"kind", device.kind},
            {"usable", device.isUsable()},
            {"problem", nullptr},
            {"reason", device.reason},
            {"remedy", device.isUsable() ? "" : device.remedy},
            {"needs", device.needs},
            {"kernel_driver", device.kernelDriver},
            {"node", nullptr}};
  if (device.problem) json["problem"] = problemName(*device.problem);
  if (!device.plugin) json["node"] = device.usb.node();
  return json;
}

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string devicesText(std::span<const DeviceListing> devices, std::span<const MissingDriver> missing) {
  std::string text;
  for (const DeviceListing& device : devices)
    text += listingLine(device) + "\n";
  if (devices.empty()) text = "No supported device is plugged in.\n";
  if (!missing.empty()) text += "Drivers of makers that are not installed:\n";
  for (const MissingDriver& each : missing)
    text += oneLine(fmt::format("{}: {}", each.name, each.remedy)) + "\n";
  text += "Without a device:\n";
  for (const SimulatedHand& hand : kSimulatedHands)
    text += fmt::format("{:<10}  {}: {}\n", hand.id, hand.name, hand.use);
  return text;
}

std::string devicesJson(std::span<const DeviceListing> devices, std::span<const MissingDriver> missing) {
  Json json{{"devices", Json::array()}, {"missing_drivers", Json::array()}, {"simulated", Json::array()}};
  for (const DeviceListing& device : devices)
    json["devices"].push_back(listingJson(device));
  for (const MissingDriver& each : missing)
    json["missing_drivers"].push_back({{"name", each.name}, {"remedy", each.remedy}});
  for (const SimulatedHand& hand : kSimulatedHands)
    json["simulated"].push_back({{"id", hand.id}, {"name", hand.name}, {"use", hand.use}});
  return dump(json);
}

std::string arrivalText(const DeviceListing& device, bool hasCome) {
  return (hasCome ? "+ " + listingLine(device) : oneLine("- " + device.place + "  " + device.name)) + "\n";
}

std::string arrivalJson(const DeviceListing& device, bool hasCome) {
  return dump({{"event", hasCome ? "arrived" : "left"}, {"device", listingJson(device, hasCome)}});
}

}  // namespace nearfit::cli
