#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "tests/usb/emulated_device.h"
#include "tests/usb/polhem_firmware.h"
#include "tests/usb/report_stream.h"

namespace nearfit::test {

/// A WoodenHaptics for an EmulatedBus: with its own board, or with a Teensy, which has a second interface.
class PolhemEmulator {
 public:
  enum class Board { Own, Teensy };
  explicit PolhemEmulator(Board board = Board::Own);

  const std::shared_ptr<EmulatedDevice>& device() const { return device_; }
  /// What `use` gives, called with the firmware and nobody else at it.
  template <class Use>
  auto withFirmware(Use&& use) {
    const std::lock_guard lock(mutex_);
    return use(firmware_);
  }

  struct Motion {
    std::function<void(PolhemFirmware&)> hand = nullptr;  ///< Turns the joints, before each report.
    std::uint64_t count = 0;                              ///< Of reports; 0: without end.
    double rate = 1000.0;                                 ///< At most [Hz].
  };
  /// Answers each command with a report from now on, beginning with what came since the last.
  void stream(const Motion& motion);
  void stream() { stream(Motion{}); }
  void join() { reports_->join(); }
  /// As it is without power: its stream has ended, nothing waits to be answered.
  void powerOff();
  /// Of the next report's bytes on their way, once.
  void damageNext(std::function<void(Bytes&)> damage);
  void stopStreaming();
  ReportStream::Counts counts() const { return reports_ ? reports_->counts() : ReportStream::Counts{}; }

 private:
  Bytes report(const Motion& motion);

  std::mutex mutex_;
  PolhemFirmware firmware_;
  std::shared_ptr<EmulatedDevice> device_;
  std::function<void(Bytes&)> damage_;
  std::uint64_t sent_ = 0;  ///< Reports, in streams that have ended.
  std::optional<ReportStream> reports_;
};

}  // namespace nearfit::test
