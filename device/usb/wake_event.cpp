#include "device/usb/wake_event.h"

#include <cerrno>
#include <cstdint>
#include <system_error>

#include <sys/eventfd.h>
#include <unistd.h>

namespace nearfit::usb {

WakeEvent::WakeEvent() : descriptor_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

WakeEvent::~WakeEvent() {
  ::close(descriptor_);
}

void WakeEvent::ring() const noexcept {
  const std::uint64_t one = 1;
  // Fails only if 2^64 - 2 rings wait, and then it rings anyway.
  [[maybe_unused]] const ssize_t ignored = ::write(descriptor_, &one, sizeof one);
}

bool WakeEvent::take() const noexcept {
  std::uint64_t rung = 0;
  return ::read(descriptor_, &rung, sizeof rung) > 0;
}

}  // namespace nearfit::usb
