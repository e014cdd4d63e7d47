#include <algorithm>
#include <cerrno>
#include <cstring>

#include <sys/ioctl.h>

#include "tests/usb/emulated_device.h"

/// The part of EmulatedDevice that answers ioctls; Documentation/driver-api/usb/usb.rst and devio.c of Linux
/// say what each means.
namespace nearfit::test {
namespace {

constexpr std::size_t kSetupSize = 8;

int failWith(int error) {
  errno = error;
  return -1;
}

std::uint16_t word(const std::byte* bytes) {
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[0]) | std::to_integer<unsigned>(bytes[1])
                                                                              << 8U);
}

ControlRequest requestOf(const usbdevfs_urb& urb) {
  const std::byte* bytes = static_cast<const std::byte*>(urb.buffer);
  ControlRequest request{std::to_integer<std::uint8_t>(bytes[0]),
                         std::to_integer<std::uint8_t>(bytes[1]),
                         word(bytes + 2),
                         word(bytes + 4),
                         word(bytes + 6),
                         {}};
  if ((request.type & 0x80U) == 0) request.data = {bytes + kSetupSize, request.length};
  return request;
}

}  // namespace

int EmulatedDevice::control(int descriptor, unsigned long request, void* argument) {
  Lock lock(mutex_);
  UsbfsFile* file = find(descriptor);
  if (file == nullptr) return failWith(EBADF);
  // What ended before it was unplugged can be reaped still.
  if (request == USBDEVFS_REAPURBNDELAY) return reap(*file, static_cast<void**>(argument));
  if (file->isGone) return failWith(ENODEV);
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES:
      *static_cast<std::uint32_t*>(argument) = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                                               USBDEVFS_CAP_REAP_AFTER_DISCONNECT |
                                               USBDEVFS_CAP_BULK_SCATTER_GATHER;
      return 0;
    case USBDEVFS_CLAIMINTERFACE:
      return claim(*file, *static_cast<unsigned*>(argument));
    case USBDEVFS_RELEASEINTERFACE:
      return release(*file, *static_cast<unsigned*>(argument));
    case USBDEVFS_GETDRIVER:
      return driverOf(*static_cast<usbdevfs_getdriver*>(argument));
    case USBDEVFS_IOCTL:
      return detachOrAttach(*static_cast<usbdevfs_ioctl*>(argument));
    case USBDEVFS_DISCONNECT_CLAIM:
      return detachAndClaim(*file, *static_cast<usbdevfs_disconnect_claim*>(argument));
    case USBDEVFS_CLEAR_HALT:
      halted_.erase(static_cast<std::uint8_t>(*static_cast<unsigned*>(argument)));
      ++haltsCleared_;
      return 0;
    case USBDEVFS_SETINTERFACE:
    case USBDEVFS_SETCONFIGURATION:
    case USBDEVFS_RESET:
      return 0;
    case USBDEVFS_SUBMITURB:
      return submit(*file, static_cast<usbdevfs_urb*>(argument), lock);
    case USBDEVFS_DISCARDURB:
      return discard(*file, static_cast<usbdevfs_urb*>(argument));
    default:
      return failWith(ENOTTY);
  }
}

int EmulatedDevice::claim(UsbfsFile& file, unsigned interfaceNumber) {
  if (interfaceNumber >= description_.interfaces.size()) return failWith(ENOENT);
  UsbfsFile* holder = claimant(interfaceNumber);
  if (holder == &file) return 0;
  if (holder != nullptr || bound_.contains(interfaceNumber) || elsewhere_.contains(interfaceNumber))
    return failWith(EBUSY);
  file.claimed.insert(interfaceNumber);
  return 0;
}

int EmulatedDevice::release(UsbfsFile& file, unsigned interfaceNumber) {
  return file.claimed.erase(interfaceNumber) > 0 ? 0 : failWith(EINVAL);
}

int EmulatedDevice::driverOf(usbdevfs_getdriver& answer) const {
  const unsigned number = answer.interface;
  std::string name;
  if (bound_.contains(number))
    name = description_.interfaces[number].kernelDriver;
  else if (elsewhere_.contains(number) || claimant(number) != nullptr)
    name = "usbfs";
  if (name.empty()) return failWith(ENODATA);
  std::strncpy(answer.driver, name.c_str(), sizeof answer.driver - 1);
  answer.driver[sizeof answer.driver - 1] = '\0';
  return 0;
}

int EmulatedDevice::detachOrAttach(const usbdevfs_ioctl& request) {
  const unsigned number = static_cast<unsigned>(request.ifno);
  if (number >= description_.interfaces.size()) return failWith(EINVAL);
  const bool isFree = claimant(number) == nullptr && !elsewhere_.contains(number);
  switch (static_cast<unsigned>(request.ioctl_code)) {
    case USBDEVFS_DISCONNECT:
      return bound_.erase(number) > 0 ? 0 : failWith(ENODATA);
    case USBDEVFS_CONNECT:
      // As device_attach(): 1 where a driver was found.
      if (bound_.contains(number) || !isFree) return failWith(EBUSY);
      if (description_.interfaces[number].kernelDriver.empty()) return 0;
      bound_.insert(number);
      return 1;
    default:
      return failWith(ENOTTY);
  }
}

int EmulatedDevice::detachAndClaim(UsbfsFile& file, const usbdevfs_disconnect_claim& request) {
  const unsigned number = request.interface;
  if (number >= description_.interfaces.size()) return failWith(EINVAL);
  // libusb asks to leave another program (driver "usbfs") alone.
  const bool isProgram = elsewhere_.contains(number) || claimant(number) != nullptr;
  if ((request.flags & USBDEVFS_DISCONNECT_CLAIM_EXCEPT_DRIVER) != 0 && isProgram) return failWith(EBUSY);
  bound_.erase(number);
  return claim(file, number);
}

int EmulatedDevice::submit(UsbfsFile& file, usbdevfs_urb* urb, Lock& lock) {
  urb->status = -EINPROGRESS;
  urb->actual_length = 0;
  file.submit(urb);
  if (!isHanging_ || UsbfsFile::isFromDevice(*urb)) handle(file, urb, lock);
  changed_.notify_all();
  return 0;
}

/// Ends a request, or leaves it pending.
void EmulatedDevice::handle(UsbfsFile& file, usbdevfs_urb* urb, Lock& lock) {
  if (failure_ != 0) {
    file.complete(urb, -failure_, 0);
  } else if (urb->type == USBDEVFS_URB_TYPE_CONTROL) {
    submitControl(file, urb, lock);
  } else if (halted_.contains(urb->endpoint) || haltedForGood_.contains(urb->endpoint)) {
    file.complete(urb, -EPIPE, 0);
  } else if ((urb->endpoint & 0x80U) == 0) {
    submitOut(file, urb, lock);
  }
}

/// The firmware may ask anything of this device meanwhile, and it may be unplugged.
void EmulatedDevice::submitControl(UsbfsFile& file, usbdevfs_urb* urb, Lock& lock) {
  const ControlRequest request = requestOf(*urb);
  lock.unlock();
  const std::optional<Bytes> reply = answer(request);
  lock.lock();
  if (!file.isPending(urb)) return;
  if (!reply) {
    file.complete(urb, -EPIPE, 0);
  } else if ((request.type & 0x80U) == 0) {
    file.complete(urb, 0, request.length);
  } else {
    const std::size_t length = std::min<std::size_t>(reply->size(), request.length);
    if (length > 0) std::memcpy(static_cast<std::byte*>(urb->buffer) + kSetupSize, reply->data(), length);
    file.complete(urb, 0, length);
  }
}

std::optional<Bytes> EmulatedDevice::answer(const ControlRequest& request) const {
  constexpr std::uint8_t kGetDescriptor = 6, kStandardTypes = 0x60, kIn = 0x80;
  if ((request.type & kStandardTypes) == 0 && (request.type & kIn) != 0 && request.request == kGetDescriptor)
    return descriptorFor(description_, request.value, request.index);
  return onControl ? onControl(request) : std::nullopt;
}

void EmulatedDevice::submitOut(UsbfsFile& file, usbdevfs_urb* urb, Lock& lock) {
  const std::size_t length = static_cast<std::size_t>(urb->buffer_length);
  if (onPacket) {
    lock.unlock();
    onPacket(urb->endpoint, {static_cast<const std::byte*>(urb->buffer), length});
    lock.lock();
  }
  if (file.isPending(urb)) file.complete(urb, 0, length);
}

int EmulatedDevice::discard(UsbfsFile& file, usbdevfs_urb* urb) {
  if (!file.isPending(urb)) return failWith(EINVAL);
  file.complete(urb, -ENOENT, 0);
  return 0;
}

int EmulatedDevice::reap(UsbfsFile& file, void** urb) {
  *urb = file.reap();
  if (*urb != nullptr) return 0;
  return failWith(file.isGone ? ENODEV : EAGAIN);
}

}  // namespace nearfit::test
