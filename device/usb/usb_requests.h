#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>

#include "device/usb/libusb_handles.h"

namespace nearfit::usb {

/// Setup packet of a control transfer, without its length.
struct ControlSetup {
  std::uint8_t type = 0, request = 0;
  std::uint16_t value = 0, index = 0;
};

/// Control transfers to a device whose events a streaming thread handles. libusb's own blocking calls would
/// handle events themselves, and so run the streaming thread's callbacks on the caller's thread.
class Requests {
 public:
  explicit Requests(libusb_device_handle* handle) noexcept : handle_(handle) {}

  /// Transfers and waits for the end. Controlling thread.
  /// @param data     At most 65535 bytes; receives the answer, or holds what is sent.
  /// @param timeout  [ms], > 0.
  /// @return Bytes transferred, or libusb's error, < 0; std::nullopt if events are no longer handled.
  std::optional<int> run(const ControlSetup& setup, std::span<std::byte> data, unsigned timeout);
  using Answer = std::function<void(std::span<const std::byte>)>;
  /// Sends a request without waiting, on the thread that handles the events. `take` receives the answer on
  /// the same thread; it is not called if there is none.
  /// @param size  Longest answer [bytes].
  void ask(const ControlSetup& setup, std::size_t size, unsigned timeout, Answer take) noexcept;
  /// Closes if no request is under way, on the thread that handles the events. Returns true once closed; no
  /// request can begin then.
  bool close() noexcept;

 private:
  struct Waiter;
  struct Question;
  static void LIBUSB_CALL onDone(libusb_transfer* transfer) noexcept;
  static void LIBUSB_CALL onAnswered(libusb_transfer* transfer) noexcept;
  /// Counts a request as under way. Returns false if closed.
  bool begin() noexcept;
  void end() noexcept;

  libusb_device_handle* handle_;
  std::mutex mutex_;
  unsigned underWay_ = 0;
  bool isClosed_ = false;
};

}  // namespace nearfit::usb
