#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/usb/emulated_device.h"

namespace nearfit::test {

/// A bus of emulated devices in place of the machine's: sysfs, udev and hotplug by umockdev, device nodes by
/// UsbfsNode. What is created and used in this process between its construction and destruction sees no other
/// USB device. One at a time; one thread.
class EmulatedBus {
 public:
  /// Throws std::runtime_error when umockdev is not linked in or preloaded.
  EmulatedBus();
  /// Unplugs what is plugged in.
  ~EmulatedBus();
  EmulatedBus(const EmulatedBus&) = delete;
  EmulatedBus& operator=(const EmulatedBus&) = delete;

  static constexpr std::uint8_t kBus = 1;

  /// The system tells its listeners before this returns; when they see to it is their matter.
  /// @param port  Of the root hub; a device that is plugged in again gets a new address, as by Linux.
  /// @return      Its address.
  std::uint8_t plug(const std::shared_ptr<EmulatedDevice>& device, unsigned port = 1);
  void unplug(EmulatedDevice& device, Unplugging how = Unplugging::Shutdown);

 private:
  struct Testbed;
  struct Plugged {
    std::shared_ptr<EmulatedDevice> device;
    std::string node, sysfs;
    std::vector<std::string> hidSysfs{};
  };
  void remove(const Plugged& plugged);

  std::unique_ptr<Testbed> testbed_;
  std::vector<Plugged> plugged_;
  std::uint8_t lastAddress_ = 1;  ///< The root hub's.
};

}  // namespace nearfit::test
