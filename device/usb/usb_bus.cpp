#include "device/usb/usb_bus.h"

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <tuple>

#include "device/usb/libusb_handles.h"

namespace nearfit {

struct UsbBus::Shared {
  usb::Context context = usb::openContext();
  bool hasHotplug = false;
  libusb_hotplug_callback_handle callback{};
  std::atomic<std::uint64_t> changes{0};
  std::atomic<bool> stopRequested{false};
  std::thread events;

  static int LIBUSB_CALL onChange(libusb_context*, libusb_device*, libusb_hotplug_event,
                                  void* self) noexcept {
    static_cast<Shared*>(self)->changes.fetch_add(1, std::memory_order_relaxed);
    return 0;
  }

  void run() noexcept {
    while (!stopRequested.load(std::memory_order_acquire)) {
      timeval second{1, 0};  // Only a safety net: the destructor interrupts the wait.
      libusb_handle_events_timeout_completed(context.get(), &second, nullptr);
    }
  }
};

UsbBus::UsbBus() : shared_(std::make_unique<Shared>()) {
  Shared& shared = *shared_;
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0) return;
  const int code = libusb_hotplug_register_callback(
      shared.context.get(), LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT, 0,
      LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY, &Shared::onChange,
      &shared, &shared.callback);
  if (code != 0) return;
  try {
    shared.events = std::thread([&shared] { shared.run(); });
  } catch (const std::system_error& error) {
    throw DeviceError(DeviceProblem::Failed, "USB",
                      std::string("no thread could be started: ") + error.what(),
                      "close other programs and try again");
  }
  shared.hasHotplug = true;
}

UsbBus::~UsbBus() {
  if (!shared_->events.joinable()) return;
  shared_->stopRequested.store(true, std::memory_order_release);
  libusb_hotplug_deregister_callback(shared_->context.get(), shared_->callback);
  libusb_interrupt_event_handler(shared_->context.get());
  shared_->events.join();
}

std::vector<UsbDescription> UsbBus::list() const {
  std::vector<UsbDescription> found;
  for (libusb_device* device : usb::DeviceList(shared_->context.get())) {
    if (std::optional<UsbDescription> description = usb::describe(device))
      found.push_back(std::move(*description));
  }
  std::sort(found.begin(), found.end(), [](const UsbDescription& a, const UsbDescription& b) {
    return std::tie(a.bus, a.address) < std::tie(b.bus, b.address);
  });
  return found;
}

bool UsbBus::tellsOfChanges() const noexcept {
  return shared_->hasHotplug;
}

std::uint64_t UsbBus::changes() const noexcept {
  return shared_->changes.load(std::memory_order_relaxed);
}

}  // namespace nearfit
