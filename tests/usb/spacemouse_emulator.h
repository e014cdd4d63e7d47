#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "tests/usb/emulated_device.h"
#include "tests/usb/report_stream.h"
#include "tests/usb/spacemouse_firmware.h"

namespace nearfit::test {

/// A space mouse for an EmulatedBus, with the system's HID driver bound to it, as when it is plugged in.
class SpaceMouseEmulator {
 public:
  explicit SpaceMouseEmulator(SpaceMouseFirmware::Model model = SpaceMouseFirmware::Model::Navigator);

  const std::shared_ptr<EmulatedDevice>& device() const { return device_; }

  /// What `use` gives, called with the firmware and nobody else at it.
  template <class Use>
  auto withFirmware(Use&& use) {
    const std::lock_guard lock(mutex_);
    return use(firmware_);
  }

  /// Sends what the hand does, each moment's reports one after the other, until it is told to stop.
  /// @param hand  Sets axes and buttons; time since the streaming began [s].
  /// @param rate  Of moments [Hz].
  void stream(std::function<void(SpaceMouseFirmware&, double)> hand, double rate = 125.0);
  void stopStreaming();
  ReportStream::Counts counts() const { return reports_ ? reports_->counts() : ReportStream::Counts{}; }

 private:
  std::mutex mutex_;
  SpaceMouseFirmware firmware_;
  std::shared_ptr<EmulatedDevice> device_;
  std::optional<ReportStream> reports_;
};

}  // namespace nearfit::test
