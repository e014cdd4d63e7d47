#pragma once

namespace nearfit::usb {

/// Wakes a thread that polls descriptors: an eventfd.
class WakeEvent {
 public:
  /// Throws std::system_error.
  WakeEvent();
  ~WakeEvent();
  WakeEvent(const WakeEvent&) = delete;
  WakeEvent& operator=(const WakeEvent&) = delete;

  /// To poll for input.
  int descriptor() const noexcept { return descriptor_; }
  /// Any thread; one system call.
  void ring() const noexcept;
  /// True when it has rung since the last time; never waits.
  bool take() const noexcept;

 private:
  int descriptor_;
};

}  // namespace nearfit::usb
