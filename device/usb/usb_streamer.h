#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <semaphore>
#include <span>
#include <thread>
#include <vector>

#include <poll.h>

#include "core/realtime/triple_buffer.h"
#include "device/usb/libusb_handles.h"
#include "device/usb/usb_link.h"
#include "device/usb/usb_requests.h"

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

/// Keeps the transfers of one device in flight, on its own thread; UsbLink says what for.
class Streamer {
 public:
  /// Starts the thread; packets are taken from begin() on. Context and handle must outlive this, and nobody
  /// else may handle their events. Throws std::system_error.
  Streamer(libusb_context* context, libusb_device_handle* handle, const UsbEndpoint& in,
           const UsbEndpoint* out, UsbPacketSink& sink);
  ~Streamer() { stop(); }
  Streamer(const Streamer&) = delete;
  Streamer& operator=(const Streamer&) = delete;

  /// Begins to take packets; call it once.
  void begin() noexcept { mayBegin_.release(); }
  /// Cancels all transfers and joins the thread; no-op while stopped.
  void stop() noexcept;
  /// Implements UsbLink::send().
  bool send(std::span<const std::byte> packet) noexcept;
  /// Control requests; they work while the thread handles events.
  Requests& requests() noexcept { return requests_; }

  UsbLoss loss() const noexcept { return loss_.load(std::memory_order_acquire); }
  UsbCounters counters() const noexcept;
  /// Real-time service granted to the thread.
  RealtimeGrant grant() const noexcept { return grant_; }

 private:
  struct Command {
    std::array<std::byte, UsbLink::kMaxPacket> bytes{};
    std::size_t size = 0;
    std::uint64_t serial = 0;
  };
  struct Pipe;
  /// A transfer with its buffer. While in flight, it belongs to libusb.
  struct Slot {
    Streamer* owner = nullptr;
    Pipe* pipe = nullptr;
    Transfer transfer;
    std::vector<unsigned char> buffer;
    bool isInFlight = false;
  };
  /// The transfers of one endpoint.
  struct Pipe {
    std::vector<std::unique_ptr<Slot>> slots;
    unsigned errorsInRow = 0, stallsInRow = 0;
    bool isHalted = false;  ///< Stalled; must be cleared.

    bool isIdle() const noexcept;
    void cancel() const noexcept;
  };
  struct Counters {
    std::atomic<std::uint64_t> packets{0}, oversized{0}, errors{0}, stalls{0}, commands{0}, replaced{0};
  };
  /// Several at once: what a device sends while the thread cannot run is not lost.
  static constexpr std::size_t kInSlots = 4;
  /// One is sent while the next is filled.
  static constexpr std::size_t kOutSlots = 2;

  static void LIBUSB_CALL onDone(libusb_transfer* transfer) noexcept;
  void onIn(Slot& slot) noexcept;
  void onFailure(Pipe& pipe, libusb_transfer_status status) noexcept;
  static int LIBUSB_CALL onLeft(libusb_context*, libusb_device* device, libusb_hotplug_event,
                                void* self) noexcept;

  void makeSlots(Pipe& pipe, std::size_t count, const UsbEndpoint& endpoint);
  void run() noexcept;
  /// Sleeps until there is something to do. Returns true if `wake_` rang.
  bool wait() noexcept;
  bool isOver(bool isDrained) noexcept;
  void clearHalts() noexcept;
  void clearHalt(Pipe& pipe) noexcept;
  void submitCommand() noexcept;
  void submit(Slot& slot) noexcept;
  void lose(UsbLoss loss) noexcept;

  libusb_context* context_;
  libusb_device_handle* handle_;
  UsbPacketSink& sink_;
  const bool hasOut_;
  WakeEvent wake_;  ///< Rings for a command, and for the end.
  Requests requests_;
  Pipe in_, out_;
  libusb_hotplug_callback_handle leftCallback_{};
  bool hasLeftCallback_ = false;

  TripleBuffer<Command> commands_;
  std::uint64_t nextSerial_ = 0;  ///< Used by the sender.
  std::uint64_t lastSerial_ = 0;  ///< Used by the thread: last command taken.
  std::vector<pollfd> polled_;
  std::atomic<bool> arePollsStale_{true};
  std::atomic<UsbLoss> loss_{UsbLoss::None};
  bool isLossTold_ = false;
  Counters counters_;
  RealtimeGrant grant_;
  std::binary_semaphore mayBegin_{0};
  std::atomic<bool> isGrantKnown_{false}, stopRequested_{false};
  std::thread thread_;
};

}  // namespace nearfit::usb
