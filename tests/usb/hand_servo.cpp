#include "tests/usb/hand_servo.h"

#include "device/thread/monotonic_clock.h"
#include "tests/support/eventually.h"

namespace nearfit::test {
namespace {

/// As the servo's loop has it: so long it waits for a report of a device at 1 kHz.
constexpr Nanoseconds kReportPatience = 2'000'000;

}  // namespace

bool takeReport(HapticDevice& device, HandleInput& handle) {
  return device.waitForHandle(monotonicNow() + std::chrono::nanoseconds(kPatience).count()) &&
         device.readHandle(handle);
}

bool serve(HapticDevice& device, int reports, const Wrench& wrench, HandleInput& handle) {
  for (int i = 0; i < reports; ++i) {
    if (!takeReport(device, handle)) return false;
    device.sendWrench(wrench);
  }
  return true;
}

SteadyServo::SteadyServo(HapticDevice& device, const Wrench& wrench)
    : thread_([&device, wrench, this] {
        while (!isStopping_.load()) {
          device.waitForHandle(monotonicNow() + kReportPatience);
          if (!device.readHandle(last_)) break;
          device.sendWrench(wrench);
          hasRead_.store(true);
        }
        hasEnded_.store(true);
      }) {}

HandleInput SteadyServo::stop() {
  isStopping_.store(true);
  if (thread_.joinable()) thread_.join();
  return last_;
}

}  // namespace nearfit::test
