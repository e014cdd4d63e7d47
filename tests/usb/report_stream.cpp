#include "tests/usb/report_stream.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "device/thread/realtime_thread.h"

namespace nearfit::test {
namespace {

/// How often it looks whether a report may go: at first, and when that takes its time.
constexpr std::chrono::microseconds kGlance{20}, kIdleGlance{1000};
constexpr std::chrono::milliseconds kSoon{20};
/// How often it looks whether it is to stop, while nobody asks.
constexpr std::chrono::milliseconds kStopGlance{50};

}  // namespace

void sleepUntil(Nanoseconds due) {
  const timespec until{due / kNanosecondsPerSecond, due % kNanosecondsPerSecond};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

ReportStream::ReportStream(EmulatedDevice& device, Plan plan)
    : device_(device), plan_(std::move(plan)), thread_([this] { run(); }) {}

void ReportStream::join() {
  if (thread_.joinable()) thread_.join();
}

void ReportStream::stop() {
  isStopping_.store(true);
  join();
}

void ReportStream::run() {
  RealtimeGrant grant;
  requestRealtimeScheduling(grant);
  const auto period = static_cast<Nanoseconds>(std::lround(1e9 / plan_.rate));
  Nanoseconds due = monotonicNow() + period;
  for (std::uint64_t i = 0; !isStopping_.load() && (plan_.count == 0 || i < plan_.count); ++i) {
    sleepUntil(due);
    if (plan_.mayGo && !waitToGo(i)) return;
    const Bytes report = plan_.report(i);
    if (!send(report)) return;
    // Late ones are not made up for by a burst.
    due = std::max(due + period, monotonicNow());
  }
}

bool ReportStream::send(const Bytes& report) {
  const Nanoseconds end = monotonicNow() + std::chrono::nanoseconds(kPatience).count();
  bool hadToWait = false;
  for (;;) {
    const EmulatedDevice::Sending sending = device_.send(plan_.endpoint, report, kStopGlance);
    if (sending == EmulatedDevice::Sending::Unplugged) return false;
    if (sending != EmulatedDevice::Sending::NobodyAsked) {
      count(&Counts::sent);
      if (hadToWait || sending == EmulatedDevice::Sending::HadToWait) count(&Counts::waited);
      return true;
    }
    hadToWait = true;
    if (isStopping_.load()) return false;
    if (plan_.isPatient || monotonicNow() < end) continue;
    count(&Counts::lost);
    return false;
  }
}

bool ReportStream::waitToGo(std::uint64_t report) {
  if (plan_.mayGo(report)) return true;
  count(&Counts::delayed);
  const Nanoseconds begin = monotonicNow();
  while (!plan_.mayGo(report)) {
    const std::chrono::nanoseconds waited(monotonicNow() - begin);
    if (isStopping_.load() || (!plan_.isPatient && waited > kPatience)) return false;
    // A host that is there answers soon; none is to cost nothing.
    std::this_thread::sleep_for(waited < kSoon ? kGlance : kIdleGlance);
  }
  return true;
}

void ReportStream::count(std::uint64_t Counts::* what) {
  const std::lock_guard lock(mutex_);
  ++(counts_.*what);
}

}  // namespace nearfit::test
