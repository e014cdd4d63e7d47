#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "tests/support/eventually.h"
#include "tests/usb/usb_descriptors.h"
#include "tests/usb/usbfs_emulation.h"
#include "tests/usb/usbfs_file.h"

namespace nearfit::test {

/// How being unplugged shows itself, in transfers that are in flight.
enum class Unplugging {
  NoDevice,   ///< They are never heard of again; whatever is asked gets ENODEV.
  Shutdown,   ///< They end with ESHUTDOWN.
  Protocol,   ///< They, and others that are submitted in the next while, end with EPROTO.
  Cancelled,  ///< They end as if they had been cancelled.
};

struct ControlRequest {
  std::uint8_t type = 0, request = 0;
  std::uint16_t value = 0, index = 0, length = 0;
  std::span<const std::byte> data;  ///< Of requests to the device.
};

/// A device as usbfs shows it: answers standard requests from its description, hands the rest to its
/// firmware, holds the host's requests until there is something to answer them with. Any thread.
class EmulatedDevice final : public UsbfsNode {
 public:
  explicit EmulatedDevice(EmulatedDescription description);

  /// What its firmware does; set before it is plugged in. Called on the host's threads, no lock held.
  /// Bytes to answer with (none to a request that sends some); nothing: stall.
  std::function<std::optional<Bytes>(const ControlRequest&)> onControl;
  std::function<void(std::uint8_t endpoint, std::span<const std::byte> packet)> onPacket;

  const EmulatedDescription& description() const { return description_; }

  enum class Sending { Taken, HadToWait, NobodyAsked, Unplugged };
  /// A packet to the host, when it has asked for one; waits for that, as no test may depend on how soon the
  /// host's thread runs. A program that does not ask within `patience` loses the packet.
  Sending send(std::uint8_t endpoint, std::span<const std::byte> packet,
               std::chrono::milliseconds patience = kPatience);

  // What can go wrong.
  void denyPermission(bool isDenied);
  /// Another program claims an interface, or gives it back.
  void claimElsewhere(unsigned interfaceNumber, bool isClaimed);
  /// The endpoint stalls until the host clears it, or for good.
  void stall(std::uint8_t endpoint, bool isForGood = false);
  /// What is and will be submitted ends with -`error`; 0: no more.
  void fail(int error);
  /// What is in flight, and no more, ends with -`error`.
  void breakOff(int error);
  /// Neither takes packets nor answers requests; sees to those that came meanwhile when it does so again.
  void hang(bool isHanging);
  /// Afterwards it is not there for whoever had it open. Protocol lasts until the bus has told.
  void pull(Unplugging how);
  /// For whoever opens it from now on.
  void plugIn();

  // What the host did.
  std::size_t outstanding() const;  ///< Requests that it has submitted and not reaped.
  std::size_t leftAtClose() const;  ///< Of those, what was so when it closed the device.
  bool isOpen() const;
  bool wasOpened() const;  ///< Ever.
  bool isClaimed(unsigned interfaceNumber) const;
  bool isKernelDriverBound(unsigned interfaceNumber) const;
  unsigned haltsCleared() const;
  /// Waits until so many requests wait at an endpoint; false when that takes longer than kPatience.
  bool waitForRequests(std::uint8_t endpoint, std::size_t count);

  int open() override;
  int control(int descriptor, unsigned long request, void* argument) override;
  void close(int descriptor) override;

 private:
  using Lock = std::unique_lock<std::mutex>;
  UsbfsFile* find(int descriptor) const;
  UsbfsFile* claimant(unsigned interfaceNumber) const;
  int claim(UsbfsFile& file, unsigned interfaceNumber);
  int release(UsbfsFile& file, unsigned interfaceNumber);
  int driverOf(usbdevfs_getdriver& answer) const;
  int detachOrAttach(const usbdevfs_ioctl& request);
  int detachAndClaim(UsbfsFile& file, const usbdevfs_disconnect_claim& request);
  int submit(UsbfsFile& file, usbdevfs_urb* urb, Lock& lock);
  void handle(UsbfsFile& file, usbdevfs_urb* urb, Lock& lock);
  void submitControl(UsbfsFile& file, usbdevfs_urb* urb, Lock& lock);
  void submitOut(UsbfsFile& file, usbdevfs_urb* urb, Lock& lock);
  static int discard(UsbfsFile& file, usbdevfs_urb* urb);
  static int reap(UsbfsFile& file, void** urb);
  UsbfsFile* fileWaitingAt(std::uint8_t endpoint) const;
  std::optional<Bytes> answer(const ControlRequest& request) const;

  const EmulatedDescription description_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::unique_ptr<UsbfsFile>> files_;
  std::set<unsigned> bound_;      ///< Interfaces that a driver of the system holds.
  std::set<unsigned> elsewhere_;  ///< Interfaces that another program holds.
  std::set<std::uint8_t> halted_, haltedForGood_;
  bool isPermissionDenied_ = false, isHanging_ = false, isPlugged_ = false, wasOpened_ = false;
  int failure_ = 0;
  std::size_t leftAtClose_ = 0;
  unsigned haltsCleared_ = 0;
};

}  // namespace nearfit::test
