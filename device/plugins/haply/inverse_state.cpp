#include "device/plugins/haply/inverse_state.h"

#include <nlohmann/json.hpp>

#include "device/plugins/kit/maker_library.h"

/// The service's JSON, from its public documentation (docs.haply.co/inverseSDK, versions 3.0 to 3.5: WebSocket Protocol,
/// Control Commands). Grips: "wireless_verse_grip" has "buttons" a, b, c; "verse_grip" has one "button".
namespace nearfit::haply {
namespace {

using Json = nlohmann::json;

constexpr const char* kInverses = "inverse3";
constexpr std::array kGrips = {"wireless_verse_grip", "verse_grip"};

/// Calls `act`, whose exceptions are the message's fault.
template <class Act>
auto reading(Act&& act) {
  try {
    return act();
  } catch (const Json::exception&) {
    throw plugin::PluginError("the Haply Inverse Service sent what cannot be read");
  }
}

const Json* memberOf(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

template <std::size_t n>
bool takeVector(const Json& object, const char* name, const std::array<const char*, n>& parts,
                std::array<double, n>& out) {
  const Json* const vector = memberOf(object, name);
  if (vector == nullptr) return false;
  for (std::size_t i = 0; i < n; ++i)
    if (const Json* part = memberOf(*vector, parts[i])) out[i] = part->get<double>();
  return true;
}

void takeFlag(const Json& object, const char* name, bool& out) {
  if (const Json* flag = memberOf(object, name)) out = flag->get<bool>();
}

void takeGrip(const Json& grip, InverseState& state) {
  const Json* const its = memberOf(grip, "state");
  if (its == nullptr) return;
  if (takeVector<4>(*its, "orientation", {"w", "x", "y", "z"}, state.rotation)) state.hasGrip = true;
  bool isDown = false;
  if (const Json* one = memberOf(*its, "button")) state.buttons = one->get<bool>() ? 1 : 0;
  if (const Json* buttons = memberOf(*its, "buttons")) {
    std::uint32_t bit = 1;
    for (const char* name : {"a", "b", "c"}) {
      if (memberOf(*buttons, name) != nullptr) {
        takeFlag(*buttons, name, isDown);
        state.buttons = isDown ? state.buttons | bit : state.buttons & ~bit;
      }
      bit <<= 1;
    }
  }
}

/// A number or text of an object; empty if there is none.
std::string textOf(const Json& object, const char* name) {
  const Json* const value = memberOf(object, name);
  if (value == nullptr) return {};
  if (value->is_string()) return value->get<std::string>();
  return value->is_number() ? value->dump() : std::string();
}

/// Version of the firmware by what the service says of a device; until format 3.5 it was one number.
std::string firmwareOf(const Json& info) {
  const std::string major = textOf(info, "major_version"), minor = textOf(info, "minor_version");
  if (major.empty()) return textOf(info, "firmware_version");
  return minor.empty() ? major : major + "." + minor;
}

const Json* anyGripIn(const Json& message) {
  for (const char* kind : kGrips) {
    const Json* const grips = memberOf(message, kind);
    if (grips != nullptr && grips->is_array() && !grips->empty()) return &grips->front();
  }
  return nullptr;
}

}  // namespace

std::vector<InverseListing> readInventory(const std::string& message) {
  return reading([&] {
    const Json json = Json::parse(message);
    std::vector<InverseListing> found;
    const Json* const inverses = memberOf(json, kInverses);
    if (inverses == nullptr) return found;
    for (const Json& each : *inverses) {
      InverseListing& listing = found.emplace_back();
      listing.id = each.at("device_id").get<std::string>();
      listing.hasGrip = anyGripIn(json) != nullptr;
      // The first format with "vector" also renamed what it says of the firmware.
      const Json* const config = memberOf(each, "config");
      const Json* const info = config != nullptr ? memberOf(*config, "device_info") : nullptr;
      listing.hasVectors = info != nullptr && memberOf(*info, "major_version") != nullptr;
      if (info != nullptr) listing.firmware = firmwareOf(*info);
    }
    return found;
  });
}

void takeMessage(const std::string& message, const std::string& id, InverseState& state) {
  reading([&] {
    const Json json = Json::parse(message);
    state.isThere = false;
    const Json* const inverses = memberOf(json, kInverses);
    if (inverses != nullptr) {
      for (const Json& each : *inverses) {
        if (each.at("device_id").get<std::string>() != id) continue;
        if (const Json* its = memberOf(each, "state")) {
          state.isThere = takeVector<3>(*its, "cursor_position", {"x", "y", "z"}, state.position);
          takeVector<3>(*its, "cursor_velocity", {"x", "y", "z"}, state.velocity);
        }
        if (const Json* status = memberOf(each, "status")) {
          takeFlag(*status, "calibrated", state.isCalibrated);
          takeFlag(*status, "ready", state.isReady);
          takeFlag(*status, "power_supply", state.hasPower);
        }
      }
    }
    if (const Json* grip = anyGripIn(json)) takeGrip(*grip, state);
    return 0;
  });
}

std::string forceCommand(const InverseListing& device, const std::array<double, 3>& force) {
  const Json vector{{"x", force[0]}, {"y", force[1]}, {"z", force[2]}};
  const Json command{{"set_cursor_force", {{device.hasVectors ? "vector" : "values", vector}}}};
  return Json{{kInverses, Json::array({{{"device_id", device.id}, {"commands", command}}})}}.dump();
}

std::string inventoryCommand() {
  return Json{{"session", {{"force_render_full_state", Json::object()}}}}.dump();
}

}  // namespace nearfit::haply
