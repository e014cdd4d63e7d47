#include "tests/usb/emulated_device.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace nearfit::test {

EmulatedDevice::EmulatedDevice(EmulatedDescription description) : description_(std::move(description)) {}

EmulatedDevice::Sending EmulatedDevice::send(std::uint8_t endpoint, std::span<const std::byte> packet,
                                             std::chrono::milliseconds patience) {
  Lock lock(mutex_);
  const auto canEnd = [&] { return !isPlugged_ || fileWaitingAt(endpoint) != nullptr; };
  const bool hadToWait = !canEnd();
  if (!changed_.wait_for(lock, patience, canEnd)) return Sending::NobodyAsked;
  if (!isPlugged_) return Sending::Unplugged;
  UsbfsFile& file = *fileWaitingAt(endpoint);
  file.completeIn(file.oldest(endpoint), packet);
  return hadToWait ? Sending::HadToWait : Sending::Taken;
}

UsbfsFile* EmulatedDevice::fileWaitingAt(std::uint8_t endpoint) const {
  for (const auto& file : files_) {
    if (!file->isGone && file->oldest(endpoint) != nullptr) return file.get();
  }
  return nullptr;
}

void EmulatedDevice::denyPermission(bool isDenied) {
  const Lock lock(mutex_);
  isPermissionDenied_ = isDenied;
}

void EmulatedDevice::claimElsewhere(unsigned interfaceNumber, bool isClaimed) {
  const Lock lock(mutex_);
  if (isClaimed) {
    bound_.erase(interfaceNumber);
    elsewhere_.insert(interfaceNumber);
  } else {
    elsewhere_.erase(interfaceNumber);
  }
}

void EmulatedDevice::stall(std::uint8_t endpoint, bool isForGood) {
  const Lock lock(mutex_);
  (isForGood ? haltedForGood_ : halted_).insert(endpoint);
  for (const auto& file : files_) {
    while (usbdevfs_urb* urb = file->oldest(endpoint))
      file->complete(urb, -EPIPE, 0);
  }
}

void EmulatedDevice::fail(int error) {
  const Lock lock(mutex_);
  failure_ = error;
  if (error == 0) return;
  for (const auto& file : files_)
    file->completeAll(-error);
}

void EmulatedDevice::breakOff(int error) {
  const Lock lock(mutex_);
  for (const auto& file : files_)
    file->completeAll(-error);
}

void EmulatedDevice::hang(bool isHanging) {
  Lock lock(mutex_);
  isHanging_ = isHanging_ || isHanging;
  if (isHanging) return;
  for (const auto& file : files_) {
    while (usbdevfs_urb* urb = file->oldestForDevice())
      handle(*file, urb, lock);
  }
  // Only now, so that what comes meanwhile does not overtake what waited.
  isHanging_ = false;
}

void EmulatedDevice::pull(Unplugging how) {
  const Lock lock(mutex_);
  isPlugged_ = false;
  failure_ = 0;
  halted_.clear();
  elsewhere_.clear();
  bound_.clear();
  for (const auto& file : files_) {
    if (how == Unplugging::NoDevice)
      file->forgetAll();
    else
      file->completeAll(how == Unplugging::Cancelled ? -ENOENT : -ESHUTDOWN);
    file->hangUp();
  }
  changed_.notify_all();
}

void EmulatedDevice::plugIn() {
  const Lock lock(mutex_);
  isPlugged_ = true;
  for (unsigned i = 0; i < description_.interfaces.size(); ++i) {
    if (!description_.interfaces[i].kernelDriver.empty()) bound_.insert(i);
  }
}

std::size_t EmulatedDevice::outstanding() const {
  const Lock lock(mutex_);
  std::size_t count = 0;
  for (const auto& file : files_)
    count += file->outstanding();
  return count;
}

std::size_t EmulatedDevice::leftAtClose() const {
  const Lock lock(mutex_);
  return leftAtClose_;
}

bool EmulatedDevice::isOpen() const {
  const Lock lock(mutex_);
  return !files_.empty();
}

bool EmulatedDevice::wasOpened() const {
  const Lock lock(mutex_);
  return wasOpened_;
}

bool EmulatedDevice::isClaimed(unsigned interfaceNumber) const {
  const Lock lock(mutex_);
  return claimant(interfaceNumber) != nullptr;
}

bool EmulatedDevice::isKernelDriverBound(unsigned interfaceNumber) const {
  const Lock lock(mutex_);
  return bound_.contains(interfaceNumber);
}

unsigned EmulatedDevice::haltsCleared() const {
  const Lock lock(mutex_);
  return haltsCleared_;
}

bool EmulatedDevice::waitForRequests(std::uint8_t endpoint, std::size_t count) {
  Lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, [&] {
    std::ptrdiff_t waiting = 0;
    for (const auto& file : files_) {
      waiting += std::count_if(file->pending().begin(), file->pending().end(),
                               [&](const usbdevfs_urb* urb) { return urb->endpoint == endpoint; });
    }
    return waiting >= static_cast<std::ptrdiff_t>(count);
  });
}

int EmulatedDevice::open() {
  const Lock lock(mutex_);
  if (!isPlugged_ || isPermissionDenied_) {
    errno = isPlugged_ ? EACCES : ENODEV;
    return -1;
  }
  try {
    files_.push_back(std::make_unique<UsbfsFile>());
  } catch (const std::system_error& error) {
    errno = error.code().value();
    return -1;
  }
  wasOpened_ = true;
  return files_.back()->descriptor();
}

void EmulatedDevice::close(int descriptor) {
  const Lock lock(mutex_);
  const auto found = std::find_if(files_.begin(), files_.end(),
                                  [&](const auto& file) { return file->descriptor() == descriptor; });
  if (found == files_.end()) return;
  leftAtClose_ += (*found)->outstanding();
  files_.erase(found);
}

UsbfsFile* EmulatedDevice::find(int descriptor) const {
  const auto found = std::find_if(files_.begin(), files_.end(),
                                  [&](const auto& file) { return file->descriptor() == descriptor; });
  return found == files_.end() ? nullptr : found->get();
}

UsbfsFile* EmulatedDevice::claimant(unsigned interfaceNumber) const {
  const auto found = std::find_if(files_.begin(), files_.end(), [&](const auto& file) {
    return !file->isGone && file->claimed.contains(interfaceNumber);
  });
  return found == files_.end() ? nullptr : found->get();
}

}  // namespace nearfit::test
