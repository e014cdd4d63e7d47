#include "device/servo/servo_loop.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <semaphore>
#include <utility>

#include <pthread.h>
#include <signal.h>
#include <time.h>

#include "core/base/error.h"
#include "core/parallel/parallel_for.h"
#include "core/realtime/pace_meter.h"
#include "core/realtime/triple_buffer.h"
#include "device/servo/scene_refresher.h"
#include "device/thread/monotonic_clock.h"
#include "device/thread/realtime_thread.h"

namespace nearfit {
namespace {

constexpr Nanoseconds kPeriodNs = 1'000'000;
static_assert(ServoLoop::kPeriod * 1e9 == static_cast<double>(kPeriodNs));

/// Periods without a report after which a tick runs anyway, so that the force fades.
constexpr double kReportPatience = 2.0;

/// Statistics are some 40 KB: copying them every tick would cost more than a tick's bookkeeping.
constexpr std::uint64_t kTicksPerStatistics = 100;

/// Returns the lower of each limit; NaN on either side stays, for the tick to refuse.
DeviceLimits lower(const DeviceLimits& a, const DeviceLimits& b) noexcept {
  const auto minOf = [](double x, double y) { return std::isnan(x) || x < y ? x : y; };
  DeviceLimits result = a;
  for (const auto limit :
       {&DeviceLimits::maxForce, &DeviceLimits::maxTorque, &DeviceLimits::forceSlew,
        &DeviceLimits::torqueSlew, &DeviceLimits::damping, &DeviceLimits::rotationalDamping,
        &DeviceLimits::leastMass, &DeviceLimits::leastInertia}) {
    result.*limit = minOf(a.*limit, b.*limit);
  }
  return result;
}

}  // namespace

/// State shared by both threads. The controlling thread makes it, and frees it after
/// joining the servo thread.
///
/// The floating-point mode stays the default (no flush to zero): a pose must give the same minima here as in
/// any other thread. ServoTick keeps its filter out of the denormals.
struct ServoLoop::Shared {
  Shared(HapticDevice& d, const DeviceInfo& info, std::shared_ptr<const ServoScene> scene,
         const ServoParameters& p, MotionQueue* r)
      : device(d),
        deviceLimits(info.limits),
        reportPatience(static_cast<Nanoseconds>(kReportPatience * info.reportPeriod * 1e9)),
        record(r),
        refresher(std::in_place, std::move(scene), searchReach(p.haptics)),
        parameters(p) {}

  static void* threadMain(void* self) noexcept;
  void spawn();
  void serve() noexcept;
  Nanoseconds nextDeadline(Nanoseconds last, bool hasReport) noexcept;
  /// @param late  Delay behind the deadline [s]; ignored if a report paces the tick.
  bool tickOnce(bool hasReport, Nanoseconds sinceStart, double late) noexcept;

  HapticDevice& device;
  const DeviceLimits deviceLimits;
  const Nanoseconds reportPatience;  ///< 0: this loop sets the pace.
  MotionQueue* const record;
  RealtimeGrant grant;
  std::optional<MemoryLock> memoryLock;
  std::optional<AwakeProcessors> awake;
  /// Held while this loop runs: helpers of parallel loops then leave a processor free. Without SCHED_FIFO a thread that
  /// wakes waits for theirs to be let go; with it, it still shares caches and cores with them.
  std::optional<ReservedProcessor> processor;
  pthread_t thread{};
  bool isJoinable = false;
  bool isDeviceToStop = false;
  std::binary_semaphore started{0};
  std::atomic<bool> stopRequested{false};
  std::atomic<bool> isRunning{false};
  std::atomic<bool> isClutched{false};

  std::optional<SceneRefresher> refresher;  ///< Reset, with the scenes it holds, by stop().
  TripleBuffer<ServoParameters> parameters;
  TripleBuffer<ServoSnapshot> snapshots;
  TripleBuffer<ServoStatistics> published;

  // Used by the servo thread while it runs.
  ServoTick tick;
  ServoStatistics statistics;
  PaceMeter reports;
  Nanoseconds lastBegin = 0;  ///< Start of the last tick; 0 before the first.

  LatencyHistogram lastRefreshTimes;  ///< Set by stop(); the controlling thread's.
};

void* ServoLoop::Shared::threadMain(void* self) noexcept {
  Shared& shared = *static_cast<Shared*>(self);
  requestRealtimeScheduling(shared.grant);
  shared.started.release();
  shared.serve();
  return nullptr;
}

void ServoLoop::Shared::spawn() {
  memoryLock.emplace(grant);
  if (reportPatience > 0) awake.emplace(grant);
  processor.emplace();
  // Signals go to the other threads: a handler here would run inside a tick.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  isRunning.store(true);
  // std::thread would free its state in the new thread.
  const int error = ::pthread_create(&thread, nullptr, threadMain, this);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (error != 0) {
    isRunning.store(false);
    throw Error("servo", std::string("no thread could be started (") + std::strerror(error) + ")",
                "close other programs and try again");
  }
  isJoinable = true;
  started.acquire();
}

void ServoLoop::Shared::serve() noexcept {
  const Nanoseconds start = monotonicNow() + kPeriodNs;
  Nanoseconds deadline = start;
  while (!stopRequested.load(std::memory_order_acquire)) {
    const bool hasReport = device.waitForHandle(deadline);
    const double late = toSeconds(monotonicNow() - deadline);
    if (!hasReport) statistics.lateness.record(late);
    if (!tickOnce(hasReport, (hasReport ? monotonicNow() : deadline) - start, late)) break;
    if (statistics.ticks % kTicksPerStatistics == 0) published.publish(statistics);
    deadline = nextDeadline(deadline, hasReport);
  }
  device.sendWrench(Wrench{});
  published.publish(statistics);
  isRunning.store(false, std::memory_order_release);
}

Nanoseconds ServoLoop::Shared::nextDeadline(Nanoseconds last, bool hasReport) noexcept {
  const Nanoseconds now = monotonicNow();
  // The device's next report sets the pace; of those that came during a tick, only the newest counts. In
  // silence this loop sets it, so that the force of a slow device fades smoothly and it is stopped in time.
  if (reportPatience > 0) return now + (hasReport ? reportPatience : std::min(reportPatience, kPeriodNs));
  const Nanoseconds next = last + kPeriodNs;
  if (now <= next) return next;
  // Skip whole periods: a burst to catch up would send several wrenches for one position of the hand.
  const Nanoseconds skipped = (now - next) / kPeriodNs + 1;
  statistics.overruns += static_cast<std::uint64_t>(skipped);
  return next + skipped * kPeriodNs;
}

bool ServoLoop::Shared::tickOnce(bool hasReport, Nanoseconds sinceStart, double late) noexcept {
  const Nanoseconds begin = monotonicNow();
  // The time between two readings of the hand, not between two deadlines.
  const Nanoseconds sinceLast = lastBegin == 0 ? kPeriodNs : begin - lastBegin;
  lastBegin = begin;
  HandleInput handle;
  if (!device.readHandle(handle)) return false;
  // With a report, lateness counts from its arrival.
  if (hasReport) {
    statistics.lateness.record(handle.age);
    reports.see(toSeconds(sinceStart) - handle.age);
    statistics.reportInterval = reports.interval();
    statistics.reportJitter = reports.jitter();
  }
  handle.isClutched = handle.isClutched || isClutched.load(std::memory_order_relaxed);
  parameters.update();
  ServoParameters limited = parameters.front();
  limited.limits = lower(limited.limits, deviceLimits);

  ServoSnapshot& snapshot = snapshots.back();
  const TrackedScene& tracked = refresher->latest();
  tick.feel(tracked, limited, handle, toSeconds(sinceLast), snapshot);
  device.sendWrench(snapshot.deviceWrench);
  // The age is measured after `begin`, so the sum is never too low.
  if (hasReport) statistics.roundTrip.record(handle.age + toSeconds(monotonicNow() - begin));

  tick.show(tracked, limited, snapshot);
  snapshot.tick = ++statistics.ticks;
  refresher->report({observationOf(snapshot), searchReach(limited.haptics), snapshot.tick});
  if (snapshot.lateBodies > 0) ++statistics.lateTicks;
  snapshot.time = toSeconds(sinceStart);
  snapshot.tickTime = toSeconds(monotonicNow() - begin);
  statistics.tickTime.record(snapshot.tickTime);
  statistics.queryTime.record(snapshot.queryTime);
  if (record != nullptr) record->push(motionRow(snapshot, hasReport ? handle.age : late));
  snapshots.publish();
  return true;
}

ServoLoop::ServoLoop() = default;

ServoLoop::~ServoLoop() {
  stop();
}

void ServoLoop::requireStartable(const ServoScene* scene) const {
  if (shared_ && shared_->isJoinable) throw UsageError("servo", "it is running already", "stop it first");
  if (scene == nullptr) throw UsageError("servo", "there is no scene to feel", "open one first");
}

void ServoLoop::start(HapticDevice& device, std::unique_ptr<const ServoScene> scene,
                      const ServoParameters& parameters, MotionQueue* record) {
  requireStartable(scene.get());
  device.start(scene->moving.worldFromPart);
  try {
    startWithOpen(device, std::move(scene), parameters, record);
  } catch (...) {
    device.stop();
    throw;
  }
  shared_->isDeviceToStop = true;
}

void ServoLoop::startWithOpen(HapticDevice& device, std::unique_ptr<const ServoScene> scene,
                              const ServoParameters& parameters, MotionQueue* record) {
  requireStartable(scene.get());
  // The device may know its limits only once it is open.
  auto shared = std::make_unique<Shared>(device, device.info(), std::move(scene), parameters, record);
  shared->refresher->start();
  shared->spawn();
  shared_ = std::move(shared);
}

void ServoLoop::stop() noexcept {
  if (!shared_ || !shared_->isJoinable) return;
  shared_->stopRequested.store(true, std::memory_order_release);
  ::pthread_join(shared_->thread, nullptr);
  shared_->isJoinable = false;
  shared_->memoryLock.reset();
  shared_->awake.reset();
  shared_->processor.reset();
  shared_->lastRefreshTimes = shared_->refresher->refreshTimes();
  shared_->refresher.reset();
  if (shared_->isDeviceToStop) shared_->device.stop();
}

bool ServoLoop::isRunning() const noexcept {
  return shared_ && shared_->isRunning.load(std::memory_order_acquire);
}

void ServoLoop::setScene(std::unique_ptr<const ServoScene> scene) {
  if (!scene) throw UsageError("servo", "there is no scene to feel", "open one first");
  if (!shared_ || !shared_->isJoinable) return;
  shared_->refresher->setScene(std::move(scene));
}

void ServoLoop::setParameters(const ServoParameters& parameters) {
  if (shared_) shared_->parameters.publish(parameters);
}

void ServoLoop::setClutched(bool isClutched) {
  if (shared_) shared_->isClutched.store(isClutched, std::memory_order_relaxed);
}

bool ServoLoop::pollSnapshot() {
  if (!shared_) return false;
  return shared_->snapshots.update();
}

const ServoSnapshot& ServoLoop::snapshot() const noexcept {
  static const ServoSnapshot none;
  return shared_ ? shared_->snapshots.front() : none;
}

ServoStatistics ServoLoop::statistics() const {
  if (!shared_) return {};
  shared_->published.update();
  ServoStatistics statistics = shared_->published.front();
  statistics.refreshTime =
      shared_->refresher ? shared_->refresher->refreshTimes() : shared_->lastRefreshTimes;
  return statistics;
}

std::string ServoLoop::schedulingNote() const {
  return shared_ ? shared_->grant.describe() : "not started";
}

}  // namespace nearfit
