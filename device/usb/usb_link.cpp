#include "device/usb/usb_link.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstring>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "device/usb/libusb_handles.h"
#include "device/usb/usb_streamer.h"

namespace nearfit {
namespace {

/// Says what holds the interface, a kernel driver or a program.
std::string holderOf(libusb_device_handle* handle, std::uint8_t interfaceNumber) {
  return libusb_kernel_driver_active(handle, interfaceNumber) == 1 ? "a system driver is using it"
                                                                   : "another program is using it";
}

[[noreturn]] void throwOpenFailed(const UsbDescription& device, int code) {
  const DeviceProblem cause = usb::problemOf(code);
  const std::string where = "USB device " + device.id() + " at " + device.node();
  switch (cause) {
    case DeviceProblem::NoPermission:
      throw DeviceError(
          cause, where, "you have no permission to open it",
          "install the udev rules (nearfit-cli devices prints the command) and plug it in again");
    case DeviceProblem::Gone:
      throw DeviceError(cause, where, "it is no longer plugged in", "plug it in again");
    default:
      throw DeviceError(cause, where, "it could not be opened: " + usb::reasonOf(code), "plug it in again");
  }
}

usb::Handle openHandle(libusb_context* context, const UsbDescription& wanted) {
  for (libusb_device* device : usb::DeviceList(context)) {
    const std::optional<UsbDescription> found = usb::describe(device);
    if (!found || !found->isSamePlugging(wanted)) continue;
    libusb_device_handle* handle = nullptr;
    const int code = libusb_open(device, &handle);
    if (code != 0) throwOpenFailed(wanted, code);
    return usb::Handle(handle);
  }
  throwOpenFailed(wanted, LIBUSB_ERROR_NO_DEVICE);
}

/// Reads a string, empty if there is none. Returns false if the device does not answer at all.
bool readString(libusb_device_handle* handle, std::uint8_t index, std::string& result) {
  result.clear();
  if (index == 0) return true;
  std::array<unsigned char, 256> text{};
  const int length =
      libusb_get_string_descriptor_ascii(handle, index, text.data(), static_cast<int>(text.size()));
  if (length <= 0) return length != LIBUSB_ERROR_TIMEOUT && length != LIBUSB_ERROR_NO_DEVICE;
  for (const unsigned char c : std::span(text).first(static_cast<std::size_t>(length)))
    result += c < 0x20 || c > 0x7e ? '?' : static_cast<char>(c);  // Safe for a terminal.
  return true;
}

unsigned milliseconds(UsbLink::Timeout timeout) noexcept {
  // 0 would make libusb wait for ever.
  return static_cast<unsigned>(std::clamp<std::chrono::milliseconds::rep>(timeout.count(), 1, 60'000));
}

unsigned char* bytes(std::span<const std::byte> data) noexcept {
  return reinterpret_cast<unsigned char*>(const_cast<std::byte*>(data.data()));
}

}  // namespace

const char* lossReason(UsbLoss loss) noexcept {
  switch (loss) {
    case UsbLoss::None:
      return "";
    case UsbLoss::Unplugged:
      return "it was unplugged";
    case UsbLoss::Refused:
      return "it accepts no more transfers, as if it were unplugged";
    case UsbLoss::Cancelled:
      return "the system ended its transfers, as if it were unplugged";
    case UsbLoss::Errors:
      return "it sent only transmission errors";
    case UsbLoss::Stalled:
      return "it stalls again each time the stall is cleared";
  }
  return "";
}

struct UsbLink::Shared {
  UsbDescription device;
  std::uint8_t interfaceNumber = 0;
  usb::Context context = usb::openContext();
  usb::Handle handle;
  std::optional<usb::Streamer> streamer;
  UsbLoss lastLoss = UsbLoss::None;
  UsbCounters lastCounters;

  std::string where() const { return "USB device " + device.id() + " at " + device.node(); }

  [[noreturn]] void fail(int code, std::string_view what) const {
    throw DeviceError(usb::problemOf(code), where(), std::string(what) + ": " + usb::reasonOf(code),
                      "plug it in again");
  }

  /// Returns the bytes transferred, or libusb's error.
  int request(const usb::ControlSetup& setup, std::span<std::byte> data, Timeout timeout) {
    assert(data.size() <= 0xffff);
    if (streamer) {
      if (const std::optional<int> code = streamer->requests().run(setup, data, milliseconds(timeout)))
        return *code;
    }
    return libusb_control_transfer(handle.get(), setup.type, setup.request, setup.value, setup.index,
                                   bytes(data), static_cast<std::uint16_t>(data.size()),
                                   milliseconds(timeout));
  }

  void claim() {
    if (device.findInterface(interfaceNumber) == nullptr) {
      throw DeviceError(DeviceProblem::Unsupported, where(),
                        "it has no interface " + std::to_string(interfaceNumber),
                        "check that it is a supported device");
    }
    // May fail: a system that cannot detach drivers has none bound.
    libusb_set_auto_detach_kernel_driver(handle.get(), 1);
    const int code = libusb_claim_interface(handle.get(), interfaceNumber);
    if (code == 0) return;
    if (code == LIBUSB_ERROR_BUSY) {
      throw DeviceError(DeviceProblem::Busy, where(), holderOf(handle.get(), interfaceNumber),
                        "close the program that uses it (spacenavd, another Nearfit) and try again");
    }
    fail(code, "its interface " + std::to_string(interfaceNumber) + " could not be claimed");
  }
};

UsbLink::UsbLink(const UsbDescription& device, std::uint8_t interfaceNumber)
    : shared_(std::make_unique<Shared>()) {
  shared_->device = device;
  shared_->interfaceNumber = interfaceNumber;
  shared_->handle = openHandle(shared_->context.get(), device);
  shared_->claim();
}

UsbLink::~UsbLink() {
  stop();
  // Fails if the device is unplugged, when there is nothing to release.
  libusb_release_interface(shared_->handle.get(), shared_->interfaceNumber);
}

UsbLink::Strings UsbLink::strings() const {
  libusb_device_handle* handle = shared_->handle.get();
  libusb_device_descriptor descriptor;
  if (libusb_get_device_descriptor(libusb_get_device(handle), &descriptor) != 0) return {};
  Strings strings;
  // libusb waits a second for each; stop at the first that a hung device leaves unanswered.
  [[maybe_unused]] const bool isAnswering =
      readString(handle, descriptor.iProduct, strings.product) &&
      readString(handle, descriptor.iManufacturer, strings.manufacturer) &&
      readString(handle, descriptor.iSerialNumber, strings.serial);
  return strings;
}

std::size_t UsbLink::controlIn(std::uint8_t requestType, std::uint8_t request, std::uint16_t value,
                               std::uint16_t index, std::span<std::byte> data, Timeout timeout) {
  const int code = shared_->request({requestType, request, value, index}, data, timeout);
  if (code < 0) shared_->fail(code, "it did not answer a request");
  return static_cast<std::size_t>(code);
}

void UsbLink::controlOut(std::uint8_t requestType, std::uint8_t request, std::uint16_t value,
                         std::uint16_t index, std::span<const std::byte> data, Timeout timeout) {
  // Requests to the device leave their data alone.
  const std::span<std::byte> sent(const_cast<std::byte*>(data.data()), data.size());
  const int code = shared_->request({requestType, request, value, index}, sent, timeout);
  if (code < 0) shared_->fail(code, "it refused a request");
}

void UsbLink::ask(std::uint8_t requestType, std::uint8_t request, std::uint16_t index, std::size_t size,
                  Timeout timeout, std::function<void(std::span<const std::byte>)> take) noexcept {
  if (shared_->streamer)
    shared_->streamer->requests().ask({requestType, request, 0, index}, size, milliseconds(timeout),
                                      std::move(take));
}

std::size_t UsbLink::read(std::uint8_t endpoint, std::span<std::byte> data, Timeout timeout) {
  int count = 0;
  // Linux turns a bulk transfer on an interrupt endpoint into an interrupt transfer.
  const int code = libusb_bulk_transfer(shared_->handle.get(), endpoint, bytes(data),
                                        static_cast<int>(data.size()), &count, milliseconds(timeout));
  if (code != 0 && !(code == LIBUSB_ERROR_TIMEOUT && count > 0)) shared_->fail(code, "nothing came from it");
  return static_cast<std::size_t>(count);
}

void UsbLink::write(std::uint8_t endpoint, std::span<const std::byte> data, Timeout timeout) {
  std::size_t done = 0;
  while (done < data.size()) {
    int count = 0;
    const std::span<const std::byte> rest = data.subspan(done);
    const int code = libusb_bulk_transfer(shared_->handle.get(), endpoint, bytes(rest),
                                          static_cast<int>(rest.size()), &count, milliseconds(timeout));
    if (code != 0) shared_->fail(code, "it did not accept what was sent");
    if (count == 0) shared_->fail(LIBUSB_ERROR_TIMEOUT, "it did not accept what was sent");
    done += static_cast<std::size_t>(count);
  }
}

void UsbLink::stream(const Streams& streams, UsbPacketSink& sink) {
  const UsbInterface* face = shared_->device.findInterface(shared_->interfaceNumber);
  const auto typeOf = [&](std::uint8_t address) -> const UsbEndpoint* {
    if (face == nullptr) return nullptr;
    const auto found = std::find_if(face->endpoints.begin(), face->endpoints.end(),
                                    [&](const UsbEndpoint& each) { return each.address == address; });
    return found == face->endpoints.end() ? nullptr : &*found;
  };
  const UsbEndpoint* in = typeOf(streams.in);
  const UsbEndpoint* out = streams.out == 0 ? nullptr : typeOf(streams.out);
  if (in == nullptr || !in->isIn() || (streams.out != 0 && (out == nullptr || out->isIn()))) {
    throw DeviceError(DeviceProblem::Unsupported, shared_->where(),
                      "it lacks the endpoint that its driver needs", "check that it is a supported device");
  }
  stop();
  try {
    shared_->streamer.emplace(shared_->context.get(), shared_->handle.get(), *in, out, sink);
    // Not earlier: the sink may use the streamer at once.
    shared_->streamer->begin();
  } catch (const std::system_error& error) {
    throw DeviceError(DeviceProblem::Failed, shared_->where(),
                      std::string("its reports could not be streamed: ") + error.what(),
                      "close other programs and try again");
  }
}

void UsbLink::stop() noexcept {
  if (!shared_->streamer) return;
  shared_->streamer->stop();
  shared_->lastLoss = shared_->streamer->loss();
  shared_->lastCounters = shared_->streamer->counters();
  shared_->streamer.reset();
}

bool UsbLink::send(std::span<const std::byte> packet) noexcept {
  return shared_->streamer && shared_->streamer->send(packet);
}

UsbLoss UsbLink::loss() const noexcept {
  return shared_->streamer ? shared_->streamer->loss() : shared_->lastLoss;
}

UsbCounters UsbLink::counters() const noexcept {
  return shared_->streamer ? shared_->streamer->counters() : shared_->lastCounters;
}

RealtimeGrant UsbLink::grant() const noexcept {
  return shared_->streamer ? shared_->streamer->grant() : RealtimeGrant{};
}

}  // namespace nearfit
