#pragma once

namespace nearfit::usb {

/// Wakes a thread that polls descriptors; an eventfd.
class WakeEvent {
 public:
  /// Throws std::system_error.
  WakeEvent();
  ~WakeEvent();
  WakeEvent(const WakeEvent&) = delete;
  WakeEvent& operator=(const WakeEvent&) = delete;

  /// Descriptor to poll for input.
  int descriptor() const noexcept { return descriptor_; }
  /// Wakes the thread. Any thread; makes one system call.
  void ring() const noexcept;
  /// Returns true if it rang since the last call; never waits.
  bool take() const noexcept;

 private:
  int descriptor_;
};

}  // namespace nearfit::usb
