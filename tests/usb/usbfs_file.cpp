#include "tests/usb/usbfs_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace nearfit::test {
namespace {

/// The least that a pipe holds; poll(2) says that one has room only when a whole page is free.
constexpr std::size_t kPipeSize = 4096;

}  // namespace

UsbfsFile::UsbfsFile() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0)
    throw std::system_error(errno, std::generic_category(), "pipe");
  otherEnd_ = ends[0];
  descriptor_ = ends[1];
  ::fcntl(descriptor_, F_SETPIPE_SZ, kPipeSize);
  setReady(false);
}

/// The program closes its end itself.
UsbfsFile::~UsbfsFile() {
  if (otherEnd_ >= 0) ::close(otherEnd_);
}

void UsbfsFile::setReady(bool isReady) {
  if (isReady == isReady_ || otherEnd_ < 0) return;
  isReady_ = isReady;
  std::array<char, kPipeSize> page{};
  // Past umockdev, which takes read() and write() over and asks the kernel twice more for each.
  ::syscall(isReady ? SYS_read : SYS_write, isReady ? otherEnd_ : descriptor_, page.data(), page.size());
}

bool UsbfsFile::isPending(const usbdevfs_urb* urb) const {
  return std::find(pending_.begin(), pending_.end(), urb) != pending_.end();
}

usbdevfs_urb* UsbfsFile::oldest(std::uint8_t endpoint) const {
  const auto found = std::find_if(pending_.begin(), pending_.end(), [&](const usbdevfs_urb* urb) {
    return urb->endpoint == endpoint && urb->type != USBDEVFS_URB_TYPE_CONTROL;
  });
  return found == pending_.end() ? nullptr : *found;
}

bool UsbfsFile::isFromDevice(const usbdevfs_urb& urb) {
  return urb.type != USBDEVFS_URB_TYPE_CONTROL && (urb.endpoint & 0x80U) != 0;
}

usbdevfs_urb* UsbfsFile::oldestForDevice() const {
  const auto found = std::find_if(pending_.begin(), pending_.end(),
                                  [](const usbdevfs_urb* urb) { return !isFromDevice(*urb); });
  return found == pending_.end() ? nullptr : *found;
}

void UsbfsFile::complete(usbdevfs_urb* urb, int status, std::size_t length) {
  pending_.remove(urb);
  urb->status = status;
  urb->actual_length = static_cast<int>(length);
  completed_.push_back(urb);
  setReady(true);
}

void UsbfsFile::completeIn(usbdevfs_urb* urb, std::span<const std::byte> data) {
  const std::size_t room = static_cast<std::size_t>(urb->buffer_length);
  const std::size_t length = std::min(room, data.size());
  if (length > 0) std::memcpy(urb->buffer, data.data(), length);
  complete(urb, data.size() > room ? -EOVERFLOW : 0, length);
}

void UsbfsFile::completeAll(int status) {
  while (!pending_.empty())
    complete(pending_.front(), status, 0);
}

usbdevfs_urb* UsbfsFile::reap() {
  if (completed_.empty()) return nullptr;
  usbdevfs_urb* urb = completed_.front();
  completed_.pop_front();
  if (completed_.empty()) setReady(false);
  return urb;
}

void UsbfsFile::forgetAll() {
  pending_.clear();
  completed_.clear();
}

void UsbfsFile::hangUp() {
  isGone = true;
  if (otherEnd_ >= 0) ::close(otherEnd_);
  otherEnd_ = -1;
}

}  // namespace nearfit::test
