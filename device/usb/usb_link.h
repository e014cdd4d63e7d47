#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "device/servo/realtime_thread.h"
#include "device/usb/usb_description.h"

namespace nearfit {

/// How a device was lost. Unplugging shows itself in each of these ways.
enum class UsbLoss : std::uint8_t {
  None,
  Unplugged,  ///< The system says so.
  Refused,    ///< It takes no more transfers.
  Cancelled,  ///< The system ended transfers that nobody had cancelled.
  Errors,     ///< Nothing but transmission errors, kMostErrors in a row.
  Stalled,    ///< It stalls again each time that its endpoint is cleared.
};

/// In plain words, as a sentence without a full stop; empty for None.
const char* lossReason(UsbLoss loss) noexcept;

/// Takes what a device sends, on the link's own thread: bounded work, no lock, nothing thrown.
class UsbPacketSink {
 public:
  virtual ~UsbPacketSink() = default;
  /// @param arrived  CLOCK_MONOTONIC [ns].
  virtual void onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept = 0;
  /// Once; no packet comes after it.
  virtual void onLost(UsbLoss loss) noexcept = 0;
};

struct UsbCounters {
  std::uint64_t packets = 0;    ///< Handed to the sink.
  std::uint64_t oversized = 0;  ///< Longer than the endpoint may send; thrown away.
  std::uint64_t errors = 0;     ///< Of transmission.
  std::uint64_t stalls = 0;
  std::uint64_t commands = 0;  ///< Sent and taken.
  std::uint64_t replaced = 0;  ///< Commands that a newer one took the place of before they were sent.
};

/// A device that is open, with one interface of it claimed. The kernel's driver is detached as long as this
/// lives.
///
/// While streaming, a thread of its own, under SCHED_FIFO where that is granted, keeps transfers in flight
/// and hands packets to a sink. libusb allocates and locks when transfers are submitted and completed: that
/// stays on this thread, and the servo's side (`send`) copies a packet and writes to an eventfd.
class UsbLink {
 public:
  static constexpr std::size_t kMostPacket = 1024;  ///< What an interrupt endpoint can send at most [bytes].
  static constexpr unsigned kMostErrors = 8;  ///< A burst of errors goes before some ways of unplugging.

  /// Throws DeviceError, which says why it cannot be used and what to do about it.
  UsbLink(const UsbDescription& device, std::uint8_t interfaceNumber);
  /// Ends streaming, gives the interface back. Nothing is in flight afterwards.
  ~UsbLink();
  UsbLink(const UsbLink&) = delete;
  UsbLink& operator=(const UsbLink&) = delete;

  struct Strings {
    std::string manufacturer, product, serial;  ///< Empty where the device has none.
  };
  Strings strings() const;

  using Timeout = std::chrono::milliseconds;
  /// Requests that wait for their end; controlling thread, also while it streams. They throw DeviceError.
  /// @return What came, or went, in bytes.
  std::size_t controlIn(std::uint8_t requestType, std::uint8_t request, std::uint16_t value,
                        std::uint16_t index, std::span<std::byte> data, Timeout timeout);
  void controlOut(std::uint8_t requestType, std::uint8_t request, std::uint16_t value, std::uint16_t index,
                  std::span<const std::byte> data, Timeout timeout);
  /// Asks without waiting; for a sink in its calls, on the link's thread. `take` is called there with what
  /// has come, and may lock; it is not where nothing comes.
  /// @param size  Of the answer at most [bytes].
  void ask(std::uint8_t requestType, std::uint8_t request, std::uint16_t index, std::size_t size,
           Timeout timeout, std::function<void(std::span<const std::byte>)> take) noexcept;
  /// Packets likewise, but only while it does not stream.
  std::size_t read(std::uint8_t endpoint, std::span<std::byte> data, Timeout timeout);
  void write(std::uint8_t endpoint, std::span<const std::byte> data, Timeout timeout);

  struct Streams {
    std::uint8_t in = 0;   ///< Endpoint's address.
    std::uint8_t out = 0;  ///< The same; 0 for none.
  };
  /// Packets go to `sink`, which outlives this, from now on. Throws DeviceError when an endpoint is not the
  /// interface's.
  void stream(const Streams& streams, UsbPacketSink& sink);
  /// Ends streaming: nothing is in flight afterwards, and the sink is called no more.
  void stop() noexcept;

  /// The newest packet for the device: one that was not sent yet is replaced. One thread (the servo's);
  /// allocates nothing, locks nothing. At most kMostPacket bytes; false when the device is lost.
  bool send(std::span<const std::byte> packet) noexcept;

  UsbLoss loss() const noexcept;
  UsbCounters counters() const noexcept;
  /// What real-time service the thread got.
  RealtimeGrant grant() const noexcept;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace nearfit
