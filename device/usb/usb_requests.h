#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>

#include "device/usb/libusb_handles.h"

namespace nearfit::usb {

struct ControlSetup {
  std::uint8_t type = 0, request = 0;
  std::uint16_t value = 0, index = 0;
};

/// Control transfers to a device whose events a streaming thread handles. libusb's own calls that wait would
/// handle events themselves, and so run the streaming thread's callbacks on the caller's.
class Requests {
 public:
  explicit Requests(libusb_device_handle* handle) noexcept : handle_(handle) {}

  /// Waits for its end. Controlling thread.
  /// @param data     At most 65535 bytes; what comes goes there, what goes is left as it is.
  /// @param timeout  [ms], > 0.
  /// @return         Bytes, or libusb's error, < 0; nothing when the events are handled no more.
  std::optional<int> run(const ControlSetup& setup, std::span<std::byte> data, unsigned timeout);
  using Answer = std::function<void(std::span<const std::byte>)>;
  /// Asks the device without waiting; thread that handles the events, which `take` is called on too. It is
  /// not where there is no answer.
  /// @param size  Of the answer at most [bytes].
  void ask(const ControlSetup& setup, std::size_t size, unsigned timeout, Answer take) noexcept;
  /// Thread that handles the events: true when no request is under way. None is begun afterwards.
  bool close() noexcept;

 private:
  struct Waiter;
  struct Question;
  static void LIBUSB_CALL onDone(libusb_transfer* transfer) noexcept;
  static void LIBUSB_CALL onAnswered(libusb_transfer* transfer) noexcept;
  /// Counts one that is under way; false when none may be begun.
  bool begin() noexcept;
  void end() noexcept;

  libusb_device_handle* handle_;
  std::mutex mutex_;
  unsigned underWay_ = 0;
  bool isClosed_ = false;
};

}  // namespace nearfit::usb
