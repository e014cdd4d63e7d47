#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "device/thread/realtime_thread.h"
#include "device/usb/usb_description.h"

namespace nearfit {

/// How a device was lost. Unplugging may show as any of these.
enum class UsbLoss : std::uint8_t {
  None,
  Unplugged,  ///< The system says so.
  Refused,    ///< It accepts no more transfers.
  Cancelled,  ///< The system ended transfers that we had not cancelled.
  Errors,     ///< kMaxErrors transmission errors in a row, and nothing else.
  Stalled,    ///< It stalls again whenever its endpoint is cleared.
};

/// Returns the loss in plain words, as a sentence without a full stop; empty for None.
const char* lossReason(UsbLoss loss) noexcept;

/// Receives what a device sends, on the link's own thread: bounded work, no lock, no exception.
class UsbPacketSink {
 public:
  virtual ~UsbPacketSink() = default;
  /// @param packet   Valid during the call.
  /// @param arrived  Time on CLOCK_MONOTONIC [ns].
  virtual void onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept = 0;
  /// Called once; no packet comes after it.
  virtual void onLost(UsbLoss loss) noexcept = 0;
};

/// Counters of the current or last streaming.
struct UsbCounters {
  std::uint64_t packets = 0;    ///< Passed to the sink.
  std::uint64_t oversized = 0;  ///< Longer than the endpoint may send; dropped.
  std::uint64_t errors = 0;     ///< Transmission errors.
  std::uint64_t stalls = 0;
  std::uint64_t commands = 0;  ///< Commands sent and accepted.
  std::uint64_t replaced = 0;  ///< Commands that a newer one replaced before they were sent.
};

/// An open device with one interface claimed. The kernel's driver is detached while this lives.
///
/// While streaming, its own thread, under SCHED_FIFO if granted, keeps transfers in flight and passes packets
/// to a sink. libusb allocates and locks when transfers are submitted and completed: only this thread does
/// that. The servo's side (`send`) copies a packet and writes to an eventfd.
class UsbLink {
 public:
  static constexpr std::size_t kMaxPacket = 1024;  ///< Longest packet of an interrupt endpoint [bytes].
  static constexpr unsigned kMaxErrors = 8;        ///< Some ways of unplugging begin with a burst of errors.

  /// Throws DeviceError with the reason and the remedy.
  UsbLink(const UsbDescription& device, std::uint8_t interfaceNumber);
  /// Stops streaming and releases the interface. Nothing is in flight afterwards.
  ~UsbLink();
  UsbLink(const UsbLink&) = delete;
  UsbLink& operator=(const UsbLink&) = delete;

  struct Strings {
    std::string manufacturer, product, serial;  ///< Empty if the device has none.
  };
  /// Reads the device's strings, in printable ASCII. A device that hangs takes about a second.
  Strings strings() const;

  using Timeout = std::chrono::milliseconds;
  /// Send a control request and wait for its end; controlling thread, also while streaming. controlIn()
  /// returns the number of bytes received. Throw DeviceError.
  std::size_t controlIn(std::uint8_t requestType, std::uint8_t request, std::uint16_t value,
                        std::uint16_t index, std::span<std::byte> data, Timeout timeout);
  void controlOut(std::uint8_t requestType, std::uint8_t request, std::uint16_t value, std::uint16_t index,
                  std::span<const std::byte> data, Timeout timeout);
  /// Sends a request without waiting; only for a sink, in its calls on the link's thread. `take` receives the
  /// answer on that thread and may lock; it is not called if no answer comes.
  /// @param size  Longest answer [bytes].
  void ask(std::uint8_t requestType, std::uint8_t request, std::uint16_t index, std::size_t size,
           Timeout timeout, std::function<void(std::span<const std::byte>)> take) noexcept;
  /// Transfer packets and wait, like the requests above, but only while not streaming. read() returns the
  /// number of bytes received.
  std::size_t read(std::uint8_t endpoint, std::span<std::byte> data, Timeout timeout);
  void write(std::uint8_t endpoint, std::span<const std::byte> data, Timeout timeout);

  struct Streams {
    std::uint8_t in = 0;   ///< Endpoint address.
    std::uint8_t out = 0;  ///< Endpoint address; 0 for none.
  };
  /// Starts to pass packets to `sink`, which must outlive this. Throws DeviceError if an endpoint is not the
  /// interface's or no thread can be started.
  void stream(const Streams& streams, UsbPacketSink& sink);
  /// Stops streaming: nothing is in flight afterwards, and the sink is not called again.
  void stop() noexcept;

  /// Sends the newest packet to the device; replaces one that is not sent yet. At most kMaxPacket bytes. One
  /// thread (the servo's); allocates nothing, locks nothing. Returns false if the device is lost.
  bool send(std::span<const std::byte> packet) noexcept;

  UsbLoss loss() const noexcept;
  UsbCounters counters() const noexcept;
  /// Returns the real-time service granted to the link's thread.
  RealtimeGrant grant() const noexcept;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace nearfit
