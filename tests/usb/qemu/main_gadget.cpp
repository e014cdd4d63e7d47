#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <unistd.h>

#include "device/thread/monotonic_clock.h"
#include "tests/usb/openhap_firmware.h"

/// nearfit-gadget FOLDER RATE: the reference firmware of OpenHap behind FunctionFS, so that a Linux kernel
/// has it plugged in (dummy_hcd, or a board with a USB device port). Ends when it is killed.
namespace nearfit::test {
namespace {

// FunctionFS is little-endian, and so is every machine that this is for.
static_assert(std::endian::native == std::endian::little);

constexpr std::uint8_t kPoseEndpoint = 0x81, kWrenchEndpoint = 0x02, kInterrupt = 3;
/// A report a millisecond: in frames at full speed, as 2^(4 - 1) microframes at high speed.
constexpr std::uint8_t kFullSpeedInterval = 1, kHighSpeedInterval = 4;
/// Until the host has configured it, endpoints refuse everything.
constexpr std::chrono::milliseconds kAgain{10};

struct [[gnu::packed]] Interface {
  usb_interface_descriptor face;
  usb_endpoint_descriptor_no_audio in, out;
};
struct [[gnu::packed]] Descriptors {
  usb_functionfs_descs_head_v2 head;
  std::uint32_t fullSpeedCount, highSpeedCount;
  Interface fullSpeed, highSpeed;
};
struct [[gnu::packed]] Strings {
  usb_functionfs_strings_head head;
  std::uint16_t language;
  char name[sizeof "OpenHap"];
};

Interface interfaceWith(std::uint8_t interval) {
  Interface is{};
  is.face = {sizeof is.face,
             USB_DT_INTERFACE,
             0,
             0,
             2,
             openhap::kInterfaceClass,
             openhap::kInterfaceSubclass,
             openhap::kMajorVersion,
             1};
  is.in = {sizeof is.in, USB_DT_ENDPOINT, kPoseEndpoint, kInterrupt, openhap::kPoseSize, interval};
  is.out = {sizeof is.out, USB_DT_ENDPOINT, kWrenchEndpoint, kInterrupt, openhap::kPoseSize, interval};
  return is;
}

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "nearfit-gadget: %s: %s\n", what.c_str(), std::strerror(errno));
  std::exit(1);
}

int openFile(const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR);
  if (descriptor < 0) fail(file);
  return descriptor;
}

class Gadget {
 public:
  Gadget(const std::string& folder, std::uint16_t rate)
      : rate_(rate), firmware_(capabilitiesAt(rate)), control_(openFile(folder + "/ep0")) {
    describe();
    poses_ = openFile(folder + "/ep1");
    wrenches_ = openFile(folder + "/ep2");
  }

  [[noreturn]] void run() {
    std::thread([this] { answerRequests(); }).detach();
    std::thread([this] { takeWrenches(); }).detach();
    sendPoses();
  }

 private:
  static openhap::Capabilities capabilitiesAt(std::uint16_t rate) {
    openhap::Capabilities is;
    is.rate = rate;
    is.watchdogMs = 1000;  // An emulated processor is slow.
    is.maxForce = 8.0F;
    is.maxTorque = 0.5F;
    is.mass = 0.1F;
    is.inertia = 5e-5F;
    is.damping = 0.5F;
    is.rotationalDamping = 0.002F;
    is.workspace = {0.1F, 0.1F, 0.1F};
    return is;
  }
  static double now() { return toSeconds(monotonicNow()); }

  void describe() const {
    Descriptors descriptors{};
    descriptors.head = {FUNCTIONFS_DESCRIPTORS_MAGIC_V2, sizeof descriptors,
                        FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC};
    descriptors.fullSpeedCount = descriptors.highSpeedCount = 3;
    descriptors.fullSpeed = interfaceWith(kFullSpeedInterval);
    descriptors.highSpeed = interfaceWith(kHighSpeedInterval);
    Strings strings{};
    strings.head = {FUNCTIONFS_STRINGS_MAGIC, sizeof strings, 1, 1};
    strings.language = 0x409;
    std::memcpy(strings.name, "OpenHap", sizeof strings.name);
    if (::write(control_, &descriptors, sizeof descriptors) < 0) fail("descriptors");
    if (::write(control_, &strings, sizeof strings) < 0) fail("strings");
  }

  void answerRequests() {
    usb_functionfs_event event{};
    while (::read(control_, &event, sizeof event) == sizeof event) {
      if (event.type == FUNCTIONFS_SETUP)
        answer(event.u.setup);
      else if (event.type != FUNCTIONFS_ENABLE && event.type != FUNCTIONFS_BIND &&
               event.type != FUNCTIONFS_RESUME)
        disconnect();
    }
  }

  void answer(const usb_ctrlrequest& setup) {
    std::optional<std::vector<std::byte>> bytes;
    {
      const std::lock_guard lock(mutex_);
      firmware_.onTime(now());
      bytes = firmware_.onRequest(setup.bRequestType, setup.bRequest);
    }
    const bool isIn = (setup.bRequestType & USB_DIR_IN) != 0;
    // The wrong direction stalls.
    [[maybe_unused]] ssize_t ignored = 0;
    if (isIn == bytes.has_value())
      ignored = ::write(control_, bytes ? bytes->data() : nullptr,
                        bytes ? std::min<std::size_t>(bytes->size(), setup.wLength) : 0);
    else
      ignored = ::read(control_, nullptr, 0);
  }

  void disconnect() {
    const std::lock_guard lock(mutex_);
    firmware_.onDisconnected();
    std::printf("gadget: disconnected after %llu poses and %llu wrenches, %llu ignored\n",
                static_cast<unsigned long long>(sent_.load()),
                static_cast<unsigned long long>(firmware_.accepted()),
                static_cast<unsigned long long>(firmware_.ignored()));
    std::fflush(stdout);
  }

  void takeWrenches() {
    std::array<std::byte, openhap::kPoseSize> packet{};
    for (;;) {
      const ssize_t count = ::read(wrenches_, packet.data(), packet.size());
      if (count < 0) {
        std::this_thread::sleep_for(kAgain);
        continue;
      }
      const std::lock_guard lock(mutex_);
      firmware_.onPacket(std::span(packet).first(static_cast<std::size_t>(count)), now());
    }
  }

  [[noreturn]] void sendPoses() {
    for (;;) {
      std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / rate_));
      std::array<std::byte, openhap::kPoseSize> report{};
      {
        const std::lock_guard lock(mutex_);
        // To and fro by a centimetre, two seconds each.
        const auto phase =
            static_cast<float>(sent_ % (std::uint64_t{4} * rate_)) / (2.0F * static_cast<float>(rate_));
        firmware_.handle.position = {0.01F * (phase < 1.0F ? phase : 2.0F - phase), 0.0F, 0.0F};
        report = firmware_.poseReport(now());
      }
      // Waits until the host asks for it.
      if (::write(poses_, report.data(), report.size()) < 0)
        std::this_thread::sleep_for(kAgain);
      else
        ++sent_;
    }
  }

  const std::uint16_t rate_;
  std::mutex mutex_;
  OpenHapFirmware firmware_;
  int control_, poses_ = -1, wrenches_ = -1;
  std::atomic<std::uint64_t> sent_{0};
};

}  // namespace
}  // namespace nearfit::test

int main(int argc, char** argv) {
  const int rate = argc == 3 ? std::atoi(argv[2]) : 0;
  if (rate < 1 || rate > 8000) {
    std::fprintf(stderr,
                 "usage: nearfit-gadget FOLDER RATE\n"
                 "FOLDER: where FunctionFS is mounted; RATE: poses a second, 1 to 8000\n");
    return 2;
  }
  nearfit::test::Gadget(argv[1], static_cast<std::uint16_t>(rate)).run();
}
