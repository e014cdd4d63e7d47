#include "tests/usb/emulated_bus.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <umockdev.h>

namespace nearfit::test {
namespace {

/// Linux asks a hub about a lost device after some milliseconds; transfers fail meanwhile.
constexpr std::chrono::milliseconds kHubDelay{5};

std::string hex(const Bytes& bytes) {
  std::string text;
  for (const std::byte byte : bytes)
    text += fmt::format("{:02X}", std::to_integer<unsigned>(byte));
  return text;
}

/// What umockdev-record would write of it.
std::string record(const EmulatedDescription& device, unsigned port, unsigned address) {
  const unsigned minor = (EmulatedBus::kBus - 1U) * 128U + address - 1U;
  return fmt::format(
      "P: /devices/pci0000:00/usb{0}/{0}-{1}\n"
      "N: bus/usb/{0:03}/{2:03}\n"
      "E: SUBSYSTEM=usb\nE: DRIVER=usb\nE: DEVTYPE=usb_device\n"
      "E: BUSNUM={0:03}\nE: DEVNUM={2:03}\nE: DEVNAME=/dev/bus/usb/{0:03}/{2:03}\n"
      "E: MAJOR=189\nE: MINOR={3}\n"
      "A: bConfigurationValue=1\\n\nA: busnum={0}\\n\nA: devnum={2}\\n\nA: speed={4}\\n\n"
      "A: idVendor={5:04x}\\n\nA: idProduct={6:04x}\\n\n"
      "A: manufacturer={7}\\n\nA: product={8}\\n\nA: serial={9}\\n\n"
      "H: descriptors={10}{11}\n\n",
      EmulatedBus::kBus, port, address, minor, device.speed, device.vendor, device.product,
      device.manufacturer, device.productName, device.serial, hex(deviceDescriptor(device)),
      hex(configurationDescriptor(device)));
}

/// The same of an interface that the system's HID driver has: it shows its report descriptor.
std::string recordHid(const EmulatedInterface& face, const std::string& path) {
  return fmt::format("P: {}\nE: SUBSYSTEM=hid\nH: report_descriptor={}\n\n", path,
                     hex(face.reportDescriptor));
}

/// Where such interfaces are, below /sys. The address makes the number that ends it the system's only one.
std::string hidPath(const EmulatedDescription& device, unsigned port, unsigned address, std::size_t number) {
  return fmt::format("/devices/pci0000:00/usb{0}/{0}-{1}/{0}-{1}:1.{2}/0003:{3:04X}:{4:04X}.{5:04X}",
                     EmulatedBus::kBus, port, number, device.vendor, device.product,
                     std::size_t{16} * address + number);
}

}  // namespace

struct EmulatedBus::Testbed {
  UMockdevTestbed* handle = umockdev_testbed_new();
  ~Testbed() { g_object_unref(handle); }
};

EmulatedBus::EmulatedBus() : testbed_(std::make_unique<Testbed>()) {
  // It remembers its first answer: not to be asked before there is a testbed.
  if (!umockdev_in_mock_environment()) throw std::runtime_error("umockdev's library is not preloaded");
}

EmulatedBus::~EmulatedBus() {
  while (!plugged_.empty())
    unplug(*plugged_.back().device);
}

std::uint8_t EmulatedBus::plug(const std::shared_ptr<EmulatedDevice>& device, unsigned port) {
  const std::uint8_t address = ++lastAddress_;
  Plugged plugged{device, fmt::format("/dev/bus/usb/{:03}/{:03}", kBus, address),
                  fmt::format("/sys/devices/pci0000:00/usb{0}/{0}-{1}", kBus, port)};
  device->plugIn();
  addUsbfsNode(plugged.node, device);
  GError* error = nullptr;
  std::string text = record(device->description(), port, address);
  const std::vector<EmulatedInterface>& faces = device->description().interfaces;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i].kernelDriver != "usbhid" || faces[i].reportDescriptor.empty()) continue;
    const std::string path = hidPath(device->description(), port, address, i);
    text += recordHid(faces[i], path);
    plugged.hidSysfs.push_back("/sys" + path);
  }
  if (!umockdev_testbed_add_from_string(testbed_->handle, text.c_str(), &error)) {
    const std::string message = error->message;
    g_error_free(error);
    removeUsbfsNode(plugged.node);
    throw std::runtime_error("umockdev: " + message);
  }
  plugged_.push_back(std::move(plugged));
  return address;
}

void EmulatedBus::unplug(EmulatedDevice& device, Unplugging how) {
  const auto found = std::find_if(plugged_.begin(), plugged_.end(),
                                  [&](const Plugged& each) { return each.device.get() == &device; });
  if (found == plugged_.end()) return;
  if (how == Unplugging::Protocol) {
    device.fail(EPROTO);
    std::this_thread::sleep_for(kHubDelay);
  }
  device.pull(how);
  const Plugged plugged = std::move(*found);
  plugged_.erase(found);
  remove(plugged);
}

void EmulatedBus::remove(const Plugged& plugged) {
  for (const std::string& hid : plugged.hidSysfs)
    umockdev_testbed_remove_device(testbed_->handle, hid.c_str());
  umockdev_testbed_uevent(testbed_->handle, plugged.sysfs.c_str(), "remove");
  umockdev_testbed_remove_device(testbed_->handle, plugged.sysfs.c_str());
  removeUsbfsNode(plugged.node);
}

}  // namespace nearfit::test
