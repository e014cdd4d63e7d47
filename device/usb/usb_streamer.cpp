#include "device/usb/usb_streamer.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

#include <sys/eventfd.h>
#include <unistd.h>

#include "device/thread/monotonic_clock.h"

namespace nearfit::usb {
namespace {

/// A stall is cleared. So many in a row, without a packet between, mean that the device is lost.
constexpr unsigned kMaxStalls = 3;
/// Cancelled transfers end within a frame or two; those of an unplugged device end at once.
constexpr std::chrono::seconds kDrainTime{1};
/// Only a safety net: every event ends the wait.
constexpr int kLongestWaitMs = 100;

void addOne(std::atomic<std::uint64_t>& counter) noexcept {
  counter.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

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

Streamer::Streamer(libusb_context* context, libusb_device_handle* handle, const UsbEndpoint& in,
                   const UsbEndpoint* out, UsbPacketSink& sink)
    : context_(context), handle_(handle), sink_(sink), hasOut_(out != nullptr), requests_(handle) {
  makeSlots(in_, kInSlots, in);
  if (out != nullptr) makeSlots(out_, kOutSlots, *out);
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) != 0) {
    hasLeftCallback_ = libusb_hotplug_register_callback(context_, LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT, 0,
                                                        LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
                                                        LIBUSB_HOTPLUG_MATCH_ANY, &Streamer::onLeft, this,
                                                        &leftCallback_) == 0;
  }
  libusb_set_pollfd_notifiers(
      context_, [](int, short, void* self) { static_cast<Streamer*>(self)->arePollsStale_.store(true); },
      [](int, void* self) { static_cast<Streamer*>(self)->arePollsStale_.store(true); }, this);
  thread_ = std::thread([this] { run(); });
  isGrantKnown_.wait(false, std::memory_order_acquire);
}

void Streamer::makeSlots(Pipe& pipe, std::size_t count, const UsbEndpoint& endpoint) {
  for (std::size_t i = 0; i < count; ++i) {
    auto slot = std::make_unique<Slot>();
    slot->owner = this;
    slot->pipe = &pipe;
    slot->transfer.reset(libusb_alloc_transfer(0));
    if (!slot->transfer) throw std::system_error(ENOMEM, std::generic_category(), "transfer");
    // A packet longer than the endpoint may send is dropped; a command may take several packets.
    slot->buffer.resize(endpoint.isIn() ? std::max<std::size_t>(endpoint.maxPacket, 1) : UsbLink::kMaxPacket);
    const int size = static_cast<int>(slot->buffer.size());
    if (endpoint.type == UsbTransferType::Bulk) {
      libusb_fill_bulk_transfer(slot->transfer.get(), handle_, endpoint.address, slot->buffer.data(), size,
                                &Streamer::onDone, slot.get(), 0);
    } else {
      libusb_fill_interrupt_transfer(slot->transfer.get(), handle_, endpoint.address, slot->buffer.data(),
                                     size, &Streamer::onDone, slot.get(), 0);
    }
    pipe.slots.push_back(std::move(slot));
  }
}

void Streamer::stop() noexcept {
  if (!thread_.joinable()) return;
  stopRequested_.store(true, std::memory_order_release);
  wake_.ring();
  thread_.join();
  if (hasLeftCallback_) libusb_hotplug_deregister_callback(context_, leftCallback_);
  libusb_set_pollfd_notifiers(context_, nullptr, nullptr, nullptr);
  for (Pipe* pipe : {&in_, &out_}) {
    for (std::unique_ptr<Slot>& slot : pipe->slots) {
      // The kernel still holds its buffer: leak it rather than have it written to after it is freed.
      if (slot->isInFlight) static_cast<void>(slot.release());
    }
  }
}

bool Streamer::send(std::span<const std::byte> packet) noexcept {
  if (!hasOut_ || packet.size() > UsbLink::kMaxPacket || loss() != UsbLoss::None) return false;
  Command& command = commands_.back();
  std::copy(packet.begin(), packet.end(), command.bytes.begin());
  command.size = packet.size();
  command.serial = ++nextSerial_;
  commands_.publish();
  wake_.ring();
  return true;
}

UsbCounters Streamer::counters() const noexcept {
  const auto get = [](const std::atomic<std::uint64_t>& counter) {
    return counter.load(std::memory_order_relaxed);
  };
  return {get(counters_.packets), get(counters_.oversized), get(counters_.errors),
          get(counters_.stalls),  get(counters_.commands),  get(counters_.replaced)};
}

void Streamer::run() noexcept {
  requestRealtimeScheduling(grant_);
  isGrantKnown_.store(true, std::memory_order_release);
  isGrantKnown_.notify_all();
  mayBegin_.acquire();
  for (const std::unique_ptr<Slot>& slot : in_.slots)
    submit(*slot);
  bool isEnding = false;
  std::chrono::steady_clock::time_point drainEnd;
  for (;;) {
    const bool mustEnd = stopRequested_.load(std::memory_order_acquire) || loss() != UsbLoss::None;
    if (mustEnd && !isEnding) {
      isEnding = true;
      in_.cancel();
      out_.cancel();
      drainEnd = std::chrono::steady_clock::now() + kDrainTime;
    }
    if (loss() != UsbLoss::None && !isLossTold_) {
      isLossTold_ = true;
      sink_.onLost(loss());
    }
    if (isEnding && isOver(std::chrono::steady_clock::now() > drainEnd)) return;
    // A command goes out before libusb looks for events of its own, some system calls sooner.
    if (wait() && !isEnding) submitCommand();
    timeval none{0, 0};
    libusb_handle_events_timeout_completed(context_, &none, nullptr);
    if (isEnding) continue;
    clearHalts();
    submitCommand();
  }
}

bool Streamer::wait() noexcept {
  if (arePollsStale_.exchange(false)) {
    try {
      polled_.assign(1, {wake_.descriptor(), POLLIN, 0});
      if (const libusb_pollfd** descriptors = libusb_get_pollfds(context_)) {
        for (const libusb_pollfd** each = descriptors; *each != nullptr; ++each)
          polled_.push_back({(*each)->fd, (*each)->events, 0});
        libusb_free_pollfds(descriptors);
      }
    } catch (const std::bad_alloc&) {
      arePollsStale_.store(true);
    }
  }
  int timeout = kLongestWaitMs;
  timeval next{};
  if (libusb_get_next_timeout(context_, &next) == 1) {
    const auto due = next.tv_sec * 1000 + (next.tv_usec + 999) / 1000;
    timeout = static_cast<int>(std::min<decltype(due)>(due, kLongestWaitMs));
  }
  if (::poll(polled_.data(), polled_.size(), timeout) <= 0 || polled_.front().revents == 0) return false;
  return wake_.take();
}

/// Requests are waited for as long as they take: their callers sleep until they end, at the latest by
/// their own timeouts.
bool Streamer::isOver(bool isDrained) noexcept {
  return (isDrained || (in_.isIdle() && out_.isIdle())) && requests_.close();
}

void LIBUSB_CALL Streamer::onDone(libusb_transfer* transfer) noexcept {
  Slot& slot = *static_cast<Slot*>(transfer->user_data);
  slot.isInFlight = false;
  Streamer& self = *slot.owner;
  Pipe& pipe = *slot.pipe;
  if (transfer->status == LIBUSB_TRANSFER_COMPLETED)
    pipe.errorsInRow = pipe.stallsInRow = 0;
  else
    self.onFailure(pipe, transfer->status);
  if (&pipe == &self.in_)
    self.onIn(slot);
  else if (transfer->status == LIBUSB_TRANSFER_COMPLETED)
    addOne(self.counters_.commands);
}

void Streamer::onIn(Slot& slot) noexcept {
  if (stopRequested_.load(std::memory_order_relaxed) || loss() != UsbLoss::None) return;
  const libusb_transfer& transfer = *slot.transfer;
  if (transfer.status == LIBUSB_TRANSFER_COMPLETED) {
    addOne(counters_.packets);
    sink_.onPacket(
        std::as_bytes(std::span(slot.buffer).first(static_cast<std::size_t>(transfer.actual_length))),
        monotonicNow());
  }
  if (!in_.isHalted) submit(slot);
}

/// Unplugging may show as any of these.
void Streamer::onFailure(Pipe& pipe, libusb_transfer_status status) noexcept {
  switch (status) {
    case LIBUSB_TRANSFER_NO_DEVICE:
      lose(UsbLoss::Unplugged);
      return;
    case LIBUSB_TRANSFER_CANCELLED:
      // clearHalts() cancels the transfers of a halted endpoint.
      if (!stopRequested_.load(std::memory_order_relaxed) && !pipe.isHalted) lose(UsbLoss::Cancelled);
      return;
    case LIBUSB_TRANSFER_OVERFLOW:
      addOne(counters_.oversized);
      return;
    case LIBUSB_TRANSFER_STALL:
      // All transfers in flight may end with the same stall.
      if (!std::exchange(pipe.isHalted, true)) addOne(counters_.stalls);
      return;
    default:
      addOne(counters_.errors);
      if (++pipe.errorsInRow >= UsbLink::kMaxErrors) lose(UsbLoss::Errors);
  }
}

int LIBUSB_CALL Streamer::onLeft(libusb_context*, libusb_device* device, libusb_hotplug_event,
                                 void* self) noexcept {
  Streamer& streamer = *static_cast<Streamer*>(self);
  if (device == libusb_get_device(streamer.handle_)) {
    streamer.lose(UsbLoss::Unplugged);
    streamer.wake_.ring();
  }
  return 0;
}

void Streamer::clearHalts() noexcept {
  for (Pipe* pipe : {&in_, &out_}) {
    if (!pipe->isHalted) continue;
    // Clearing resets the endpoint's data toggle: nothing may be in flight.
    if (pipe->isIdle())
      clearHalt(*pipe);
    else
      pipe->cancel();
  }
}

void Streamer::clearHalt(Pipe& pipe) noexcept {
  if (++pipe.stallsInRow > kMaxStalls) return lose(UsbLoss::Stalled);
  const int code = libusb_clear_halt(handle_, pipe.slots.front()->transfer->endpoint);
  if (code == LIBUSB_ERROR_NO_DEVICE) return lose(UsbLoss::Unplugged);
  pipe.isHalted = false;
  if (&pipe != &in_) return;
  for (const std::unique_ptr<Slot>& slot : pipe.slots)
    submit(*slot);
}

void Streamer::submitCommand() noexcept {
  const auto free =
      std::find_if(out_.slots.begin(), out_.slots.end(), [](const auto& slot) { return !slot->isInFlight; });
  if (free == out_.slots.end() || out_.isHalted || !commands_.update()) return;
  const Command& command = commands_.front();
  if (command.serial > lastSerial_ + 1)
    counters_.replaced.fetch_add(command.serial - lastSerial_ - 1, std::memory_order_relaxed);
  lastSerial_ = command.serial;
  std::memcpy((*free)->buffer.data(), command.bytes.data(), command.size);
  (*free)->transfer->length = static_cast<int>(command.size);
  submit(**free);
}

void Streamer::submit(Slot& slot) noexcept {
  if (stopRequested_.load(std::memory_order_relaxed) || loss() != UsbLoss::None) return;
  const int code = libusb_submit_transfer(slot.transfer.get());
  if (code == 0)
    slot.isInFlight = true;
  else
    lose(code == LIBUSB_ERROR_NO_DEVICE ? UsbLoss::Unplugged : UsbLoss::Refused);
}

void Streamer::Pipe::cancel() const noexcept {
  for (const std::unique_ptr<Slot>& slot : slots) {
    if (slot->isInFlight) libusb_cancel_transfer(slot->transfer.get());
  }
}

bool Streamer::Pipe::isIdle() const noexcept {
  return std::none_of(slots.begin(), slots.end(), [](const auto& slot) { return slot->isInFlight; });
}

/// Keeps the first reason.
void Streamer::lose(UsbLoss loss) noexcept {
  UsbLoss none = UsbLoss::None;
  loss_.compare_exchange_strong(none, loss, std::memory_order_acq_rel);
}

}  // namespace nearfit::usb
