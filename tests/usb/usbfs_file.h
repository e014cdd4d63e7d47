#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <list>
#include <set>
#include <span>

#include <linux/usbdevice_fs.h>

namespace nearfit::test {

/// One opening of a device's node: its requests (URBs), claims, and a descriptor that polls as usbfs does.
/// That is the end of a pipe to write to: with room (POLLOUT) while requests are to be reaped, full while
/// not, and with nobody at its other end (POLLERR) once the device is gone. The owner locks.
class UsbfsFile {
 public:
  /// Throws std::system_error.
  UsbfsFile();
  ~UsbfsFile();
  UsbfsFile(const UsbfsFile&) = delete;
  UsbfsFile& operator=(const UsbfsFile&) = delete;

  int descriptor() const { return descriptor_; }

  void submit(usbdevfs_urb* urb) { pending_.push_back(urb); }
  bool isPending(const usbdevfs_urb* urb) const;
  /// The oldest that waits at an endpoint; null when none does.
  usbdevfs_urb* oldest(std::uint8_t endpoint) const;
  /// Of packets and requests to the device; null when there is none.
  usbdevfs_urb* oldestForDevice() const;
  /// A packet that the device is to send.
  static bool isFromDevice(const usbdevfs_urb& urb);
  const std::list<usbdevfs_urb*>& pending() const { return pending_; }
  /// Pending no more: to be reaped.
  void complete(usbdevfs_urb* urb, int status, std::size_t length);
  /// With data as a device sends them: too many overflow.
  void completeIn(usbdevfs_urb* urb, std::span<const std::byte> data);
  void completeAll(int status);
  /// Null when there is none.
  usbdevfs_urb* reap();
  /// What is pending or to be reaped is never heard of again, and it polls as unplugged.
  void forgetAll();
  void hangUp();

  /// Requests that the host submitted and has not reaped.
  std::size_t outstanding() const { return pending_.size() + completed_.size(); }

  std::set<unsigned> claimed;
  bool isGone = false;  ///< Its device was unplugged: plugged in again it is another.

 private:
  void setReady(bool isReady);

  int descriptor_ = -1, otherEnd_ = -1;
  bool isReady_ = true;
  std::list<usbdevfs_urb*> pending_;
  std::deque<usbdevfs_urb*> completed_;
};

}  // namespace nearfit::test
