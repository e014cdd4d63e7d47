#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "core/realtime/latency_histogram.h"
#include "device/thread/monotonic_clock.h"
#include "tests/usb/emulated_device.h"
#include "tests/usb/openhap_firmware.h"
#include "tests/usb/report_stream.h"

namespace nearfit::test {

/// A device that speaks OpenHap, for an EmulatedBus: its firmware, a hand that moves its handle, and the time
/// from each pose that it sends to the first wrench that answers it.
class OpenHapEmulator {
 public:
  /// A desktop device of 8 N and 0.5 N m at 1 kHz.
  static openhap::Capabilities usualCapabilities();

  explicit OpenHapEmulator(const openhap::Capabilities& capabilities = usualCapabilities());

  const std::shared_ptr<EmulatedDevice>& device() const { return device_; }

  /// What `use` gives, called with the firmware and nobody else at it.
  template <class Use>
  auto withFirmware(Use&& use) {
    const std::lock_guard lock(mutex_);
    return use(firmware_);
  }
  OpenHapFirmware::Rendered rendered();

  struct Motion {
    /// Sets the handle as the hand has it; time since the streaming began [s].
    std::function<void(OpenHapFirmware&, double)> hand = nullptr;
    /// Of a pose's bytes on their way, and its number.
    std::function<void(Bytes&, std::uint64_t)> damage = nullptr;
    std::uint64_t count = 0;       ///< Of poses; 0: without end.
    double rate = 0.0;             ///< [Hz]; 0: as the capabilities say.
    bool waitsForAnswers = false;  ///< The next pose goes when the last was answered.
  };
  /// The next pose's bytes, for whoever sends it.
  Bytes nextPose() { return pose({}, 0); }
  /// Sends poses from now on.
  void stream(Motion motion);
  void stream() { stream(Motion{}); }
  /// Until the last, where there is one.
  void join();
  void stopStreaming();
  ReportStream::Counts counts() const;

  LatencyHistogram roundTrips() const;

 private:
  double now() const { return toSeconds(monotonicNow() - start_); }
  Bytes pose(const Motion& motion, std::uint64_t number);
  void onWrench(std::span<const std::byte> packet);

  const openhap::Capabilities capabilities_;
  const Nanoseconds start_ = monotonicNow();
  mutable std::mutex mutex_;
  OpenHapFirmware firmware_;
  std::array<Nanoseconds, 65536> sentAt_{};  ///< By sequence number; 0 once answered.
  std::uint16_t lastSent_ = 0, lastAnswered_ = 0xffff;
  double streamStart_ = 0.0;
  LatencyHistogram roundTrips_;
  std::shared_ptr<EmulatedDevice> device_;
  std::optional<ReportStream> reports_;
};

}  // namespace nearfit::test
