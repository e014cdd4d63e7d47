#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include <errno.h>

#include "tests/usb/emulated_bus.h"
#include "tests/usb/emulation_kinds.h"
#include "tests/usb/emulation_options.h"

/// Preloaded into a program that knows nothing of it, by nearfit-emulate: a device on an emulated bus, from
/// before main() until the program ends.
namespace nearfit::test {
namespace {

/// How often it looks whether it is time to unplug.
constexpr std::chrono::milliseconds kGlance{5};

class Emulation {
 public:
  explicit Emulation(EmulationOptions options) : options_(std::move(options)), kind_(makeKind(options_)) {
    bus_.plug(kind_->device());
    kind_->start();
    if (options_.seconds > 0.0 || options_.reports > 0) unplugger_ = std::thread([this] { unplugInTime(); });
  }

  ~Emulation() {
    {
      const std::lock_guard lock(mutex_);
      isEnding_ = true;
    }
    ending_.notify_all();
    if (unplugger_.joinable()) unplugger_.join();
    kind_->stop();
    std::istringstream lines(kind_->summary());
    for (std::string line; std::getline(lines, line);)
      std::fprintf(stderr, "nearfit-emulate: %s\n", line.c_str());
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// Counted from when the program first looked at it, however long that took.
  bool isTime(Clock::time_point& firstOpened) const {
    if (firstOpened == Clock::time_point{} && kind_->device()->wasOpened()) firstOpened = Clock::now();
    const bool wasThere = firstOpened != Clock::time_point{};
    const std::chrono::duration<double> time(options_.seconds);
    return (options_.seconds > 0.0 && wasThere && Clock::now() - firstOpened >= time) ||
           (options_.reports > 0 && kind_->sent() >= options_.reports);
  }

  void unplugInTime() {
    std::unique_lock lock(mutex_);
    Clock::time_point firstOpened{};
    while (!isTime(firstOpened)) {
      if (ending_.wait_for(lock, kGlance, [&] { return isEnding_; })) return;
    }
    bus_.unplug(*kind_->device(), options_.unplug == "eproto"     ? Unplugging::Protocol
                                  : options_.unplug == "nodevice" ? Unplugging::NoDevice
                                                                  : Unplugging::Shutdown);
    std::fprintf(stderr, "nearfit-emulate: unplugged (%s)\n", options_.unplug.c_str());
  }

  const EmulationOptions options_;
  const std::unique_ptr<EmulatedKind> kind_;
  EmulatedBus bus_;
  std::mutex mutex_;
  std::condition_variable ending_;
  bool isEnding_ = false;
  std::thread unplugger_;
};

std::unique_ptr<Emulation> begin() {
  EmulationOptions options = EmulationOptions::fromEnvironment();
  if (options.kind.empty() || options.program != program_invocation_short_name) return nullptr;
  try {
    return std::make_unique<Emulation>(std::move(options));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nearfit-emulate: %s\n", error.what());
    std::_Exit(1);
  }
}

/// Made before main() and destroyed after it.
const std::unique_ptr<Emulation> emulation = begin();

}  // namespace
}  // namespace nearfit::test
