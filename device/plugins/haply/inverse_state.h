#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace nearfit::haply {

/// What the service says of an Inverse3; fields that a message leaves out keep their value.
struct InverseState {
  std::array<double, 3> position{}, velocity{};  ///< [m], [m/s]; x to the right, y away, z up.
  std::array<double, 4> rotation{1, 0, 0, 0};    ///< Of the grip: w, x, y, z.
  std::uint32_t buttons = 0;                     ///< Bits 0 to 2: a, b, c; of a grip with one button, bit 0.
  bool isCalibrated = false, isReady = false, hasPower = true;
  bool isThere = false;  ///< The last message had a place of it.
  bool hasGrip = false;  ///< A message had an orientation.
};

/// An Inverse3 that the service knows.
struct InverseListing {
  std::string id;
  bool hasGrip = false;  ///< The service also knows a grip, whose orientation counts as its handle's.
  /// The service speaks JSON format 3.5, whose force is a "vector"; before, it is "values".
  bool hasVectors = false;
  std::string firmware;  ///< Its version, such as "7.4"; empty if the message does not say it.
};

/// Reads the devices in the service's first message. Throws PluginError if it is not one.
std::vector<InverseListing> readInventory(const std::string& message);

/// Takes what a message says of a device. Throws PluginError if it is no JSON or a number in it is none.
void takeMessage(const std::string& message, const std::string& id, InverseState& state);

/// Command that sets the force [N], or, with nothing to command, that asks for the next state.
std::string forceCommand(const InverseListing& device, const std::array<double, 3>& force);
/// Command that asks for all of the state, as the first message has it.
std::string inventoryCommand();

}  // namespace nearfit::haply
