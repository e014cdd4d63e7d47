#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "device/thread/monotonic_clock.h"
#include "tests/usb/emulated_device.h"
#include "tests/usb/falcon_firmware.h"

namespace nearfit::test {

/// A Novint Falcon for an EmulatedBus. Its FTDI chip is a thread: it sends what the device has to say, or the
/// status alone each time that the latency has passed.
class FalconEmulator {
 public:
  explicit FalconEmulator(FalconFirmware::Bytes image);
  ~FalconEmulator();
  FalconEmulator(const FalconEmulator&) = delete;
  FalconEmulator& operator=(const FalconEmulator&) = delete;

  const std::shared_ptr<EmulatedDevice>& device() const { return device_; }
  template <class Use>
  auto withFirmware(Use&& use) {
    const std::lock_guard lock(mutex_);
    return use(firmware_);
  }
  /// The hand moves the handle just before each command is answered.
  void moveWith(std::function<void(FalconFirmware&)> hand);
  /// So many packets a second at most, as over a real bus, instead of as fast as the host goes [Hz].
  void paceAt(double rate) { period_.store(static_cast<Nanoseconds>(1e9 / rate)); }

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable hasBytes_;
  FalconFirmware firmware_;
  std::shared_ptr<EmulatedDevice> device_;
  std::function<void(FalconFirmware&)> hand_;
  std::atomic<Nanoseconds> period_{0};
  std::atomic<bool> isStopping_{false};
  std::thread chip_;
};

}  // namespace nearfit::test
