#include "device/spacemouse/spacemouse_models.h"

#include <algorithm>
#include <array>

#include "device/hid/system_descriptor.h"
#include "device/spacemouse/spacemouse_reader.h"

namespace nearfit::spacemouse {
namespace {

constexpr std::uint16_t kLogitech = 0x046d, k3Dconnexion = 0x256f;
// Source of all USB IDs: spacenavd's lists of devices.
constexpr std::array<std::uint16_t, 11> kOfLogitech = {0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625,
                                                       0xc626, 0xc627, 0xc628, 0xc629, 0xc62b};
/// 3Dconnexion's own IDs. Newer models are recognised by their axes.
constexpr std::array<std::uint16_t, 7> kSpaceMice = {0xc62e, 0xc62f, 0xc631, 0xc632, 0xc633, 0xc635, 0xc636};
/// All CadMouse models.
constexpr std::array<std::uint16_t, 7> kOrdinaryMice = {0xc650, 0xc651, 0xc654, 0xc655,
                                                        0xc656, 0xc657, 0xc658};

/// HID 1.11, 4.2 and 4.3: an interface that declares itself a keyboard or a mouse.
constexpr std::uint8_t kHidClass = 3, kBootSubclass = 1;

template <std::size_t Count>
bool contains(const std::array<std::uint16_t, Count>& numbers, std::uint16_t number) noexcept {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

bool isReader(const UsbInterface& face) noexcept {
  return face.classCode == kHidClass && face.streaming(true) != nullptr;
}

bool isOrdinaryMouse(const UsbDescription& device) noexcept {
  return device.vendor == k3Dconnexion && contains(kOrdinaryMice, device.product);
}

enum class Axes : std::uint8_t { Six, Fewer, Unknown };

Axes axesOf(const UsbDescription& device, const UsbInterface& face) {
  if (const auto descriptor = systemReportDescriptor(device, face.number)) {
    if (SpaceMouseReader::fromDescriptor(*descriptor)) return Axes::Six;
    if (parseReportDescriptor(*descriptor)) return Axes::Fewer;
  }
  return face.subclass == kBootSubclass && face.protocol != 0 ? Axes::Fewer : Axes::Unknown;
}

}  // namespace

bool isOfMaker(const UsbDescription& device) noexcept {
  const bool isTheirs =
      device.vendor == k3Dconnexion || (device.vendor == kLogitech && contains(kOfLogitech, device.product));
  return isTheirs && std::any_of(device.interfaces.begin(), device.interfaces.end(), isReader);
}

bool isKnownModel(const UsbDescription& device) noexcept {
  return (device.vendor == k3Dconnexion && contains(kSpaceMice, device.product)) ||
         (device.vendor == kLogitech && contains(kOfLogitech, device.product));
}

std::vector<const UsbInterface*> candidates(const UsbDescription& device) {
  std::vector<const UsbInterface*> sure, possible;
  if (isOrdinaryMouse(device)) return sure;
  for (const UsbInterface& each : device.interfaces) {
    if (!isReader(each)) continue;
    const Axes axes = axesOf(device, each);
    if (axes == Axes::Six) sure.push_back(&each);
    if (axes == Axes::Unknown) possible.push_back(&each);
  }
  sure.insert(sure.end(), possible.begin(), possible.end());
  return sure;
}

std::optional<DeviceRefusal> whyNone(const UsbDescription& device) {
  if (isOrdinaryMouse(device)) {
    return DeviceRefusal{"it is an ordinary mouse, not a space mouse with six axes", "choose a space mouse"};
  }
  if (candidates(device).empty()) return noSixAxes();
  return std::nullopt;
}

DeviceRefusal noSixAxes() {
  return {"it lacks the six axes of a space mouse", "choose a space mouse"};
}

}  // namespace nearfit::spacemouse
