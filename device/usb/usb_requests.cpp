#include "device/usb/usb_requests.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <semaphore>
#include <utility>
#include <vector>

namespace nearfit::usb {
namespace {

int codeOf(const libusb_transfer& transfer) noexcept {
  switch (transfer.status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return transfer.actual_length;
    case LIBUSB_TRANSFER_TIMED_OUT:
      return LIBUSB_ERROR_TIMEOUT;
    case LIBUSB_TRANSFER_STALL:
      return LIBUSB_ERROR_PIPE;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return LIBUSB_ERROR_NO_DEVICE;
    case LIBUSB_TRANSFER_OVERFLOW:
      return LIBUSB_ERROR_OVERFLOW;
    default:
      return LIBUSB_ERROR_IO;
  }
}

}  // namespace

struct Requests::Waiter {
  Requests* owner;
  std::binary_semaphore isDone{0};
};

/// Owns itself while it is under way.
struct Requests::Question {
  Requests* owner;
  Answer take;
  std::vector<unsigned char> buffer;
  Transfer transfer;
};

bool Requests::begin() noexcept {
  const std::lock_guard lock(mutex_);
  if (isClosed_) return false;
  ++underWay_;
  return true;
}

void Requests::end() noexcept {
  const std::lock_guard lock(mutex_);
  --underWay_;
}

std::optional<int> Requests::run(const ControlSetup& setup, std::span<std::byte> data, unsigned timeout) {
  const bool isIn = (setup.type & LIBUSB_ENDPOINT_IN) != 0;
  std::vector<unsigned char> buffer(LIBUSB_CONTROL_SETUP_SIZE + data.size());
  libusb_fill_control_setup(buffer.data(), setup.type, setup.request, setup.value, setup.index,
                            static_cast<std::uint16_t>(data.size()));
  unsigned char* payload = buffer.data() + LIBUSB_CONTROL_SETUP_SIZE;
  if (!isIn && !data.empty()) std::memcpy(payload, data.data(), data.size());
  const Transfer transfer(libusb_alloc_transfer(0));
  if (!transfer) return LIBUSB_ERROR_NO_MEM;
  Waiter waiter{this};
  libusb_fill_control_transfer(transfer.get(), handle_, buffer.data(), &Requests::onDone, &waiter, timeout);
  if (!begin()) return std::nullopt;
  if (const int code = libusb_submit_transfer(transfer.get()); code != 0) {
    end();
    return code;
  }
  waiter.isDone.acquire();
  const int code = codeOf(*transfer);
  if (isIn && code > 0)
    std::memcpy(data.data(), payload, std::min(data.size(), static_cast<std::size_t>(code)));
  return code;
}

/// Releases the waiter last: it may be gone at once.
void LIBUSB_CALL Requests::onDone(libusb_transfer* transfer) noexcept {
  Waiter& waiter = *static_cast<Waiter*>(transfer->user_data);
  waiter.owner->end();
  waiter.isDone.release();
}

void Requests::ask(const ControlSetup& setup, std::size_t size, unsigned timeout, Answer take) noexcept {
  try {
    auto question = std::make_unique<Question>();
    question->owner = this;
    question->take = std::move(take);
    question->buffer.resize(LIBUSB_CONTROL_SETUP_SIZE + size);
    question->transfer.reset(libusb_alloc_transfer(0));
    if (!question->transfer) return;
    libusb_fill_control_setup(question->buffer.data(), setup.type | LIBUSB_ENDPOINT_IN, setup.request,
                              setup.value, setup.index, static_cast<std::uint16_t>(size));
    libusb_fill_control_transfer(question->transfer.get(), handle_, question->buffer.data(),
                                 &Requests::onAnswered, question.get(), timeout);
    if (!begin()) return;
    if (libusb_submit_transfer(question->transfer.get()) == 0)
      static_cast<void>(question.release());
    else
      end();
  } catch (const std::bad_alloc&) {
    // Without memory there is no answer.
  }
}

void LIBUSB_CALL Requests::onAnswered(libusb_transfer* transfer) noexcept {
  const std::unique_ptr<Question> question(static_cast<Question*>(transfer->user_data));
  question->owner->end();
  const int count = codeOf(*transfer);
  if (count >= 0) {
    const auto bytes = std::as_bytes(std::span(question->buffer));
    question->take(bytes.subspan(LIBUSB_CONTROL_SETUP_SIZE, static_cast<std::size_t>(count)));
  }
}

bool Requests::close() noexcept {
  const std::lock_guard lock(mutex_);
  isClosed_ = isClosed_ || underWay_ == 0;
  return isClosed_;
}

}  // namespace nearfit::usb
