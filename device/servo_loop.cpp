#include "device/servo_loop.h"

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

#include "core/error.h"
#include "core/realtime/triple_buffer.h"
#include "device/realtime_thread.h"
#include "device/scene_refresher.h"

namespace nearfit {
namespace {

using Nanoseconds = std::int64_t;
constexpr Nanoseconds kSecond = 1'000'000'000;
constexpr Nanoseconds kPeriodNs = 1'000'000;
static_assert(ServoLoop::kPeriod * 1e9 == static_cast<double>(kPeriodNs));

/// Statistics are some 25 KB: copying them every tick would cost more than a tick's bookkeeping.
constexpr std::uint64_t kTicksPerStatistics = 100;

Nanoseconds now() noexcept {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * kSecond + t.tv_nsec;
}

void sleepUntil(Nanoseconds deadline) noexcept {
  const timespec t{deadline / kSecond, deadline % kSecond};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

/// The lower of each limit; not a number on either side stays one, for the tick to refuse.
DeviceLimits lower(const DeviceLimits& a, const DeviceLimits& b) noexcept {
  const auto least = [](double x, double y) { return std::isnan(x) || x < y ? x : y; };
  DeviceLimits result = a;
  for (const auto limit :
       {&DeviceLimits::maxForce, &DeviceLimits::maxTorque, &DeviceLimits::forceSlew,
        &DeviceLimits::torqueSlew, &DeviceLimits::damping, &DeviceLimits::rotationalDamping,
        &DeviceLimits::leastMass, &DeviceLimits::leastInertia}) {
    result.*limit = least(a.*limit, b.*limit);
  }
  return result;
}

double toSeconds(Nanoseconds t) noexcept {
  return static_cast<double>(t) * 1e-9;
}

}  // namespace

/// Everything that both threads see. The controlling thread makes and frees it; the servo thread is joined
/// first.
///
/// The floating-point mode is left as it is (no flush to zero): the same pose must give the same minima here
/// as in any other thread, and ServoTick keeps its filter out of the denormals.
struct ServoLoop::Shared {
  Shared(HapticDevice& d, std::shared_ptr<const ServoScene> scene, const ServoParameters& p, MotionQueue* r)
      : device(d),
        deviceLimits(d.info().limits),
        record(r),
        refresher(std::in_place, std::move(scene), searchReach(p.haptics)),
        parameters(p) {}

  static void* threadMain(void* self) noexcept;
  void spawn();
  void serve() noexcept;
  bool tickOnce(Nanoseconds sinceStart) noexcept;

  HapticDevice& device;
  const DeviceLimits deviceLimits;
  MotionQueue* const record;
  RealtimeGrant grant;
  std::optional<MemoryLock> memoryLock;
  pthread_t thread{};
  bool isJoinable = false;
  std::binary_semaphore started{0};
  std::atomic<bool> stopRequested{false};
  std::atomic<bool> isRunning{false};

  std::optional<SceneRefresher> refresher;  ///< Gone, with the scenes that it holds, once stopped.
  TripleBuffer<ServoParameters> parameters;
  TripleBuffer<ServoSnapshot> snapshots;
  TripleBuffer<ServoStatistics> published;

  // The servo thread's own while it runs.
  ServoTick tick;
  ServoStatistics statistics;
  Nanoseconds lastBegin = 0;  ///< Of a tick; 0 before the first.

  LatencyHistogram lastRefreshTimes;  ///< Once stopped; the controlling thread's.
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
  // Signals are for the other threads: a handler here would run inside a tick.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  isRunning.store(true);
  // Not std::thread: it frees its state in the new thread.
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
  const Nanoseconds start = now() + kPeriodNs;
  Nanoseconds deadline = start;
  while (!stopRequested.load(std::memory_order_acquire)) {
    sleepUntil(deadline);
    statistics.lateness.record(toSeconds(now() - deadline));
    if (!tickOnce(deadline - start)) break;
    if (statistics.ticks % kTicksPerStatistics == 0) published.publish(statistics);

    deadline += kPeriodNs;
    const Nanoseconds behind = now() - deadline;
    if (behind > 0) {
      // Skip whole periods: a burst to catch up would send several wrenches for one moment of the hand.
      const Nanoseconds skipped = behind / kPeriodNs + 1;
      statistics.overruns += static_cast<std::uint64_t>(skipped);
      deadline += skipped * kPeriodNs;
    }
  }
  device.sendWrench(Wrench{});
  published.publish(statistics);
  isRunning.store(false, std::memory_order_release);
}

bool ServoLoop::Shared::tickOnce(Nanoseconds sinceStart) noexcept {
  const Nanoseconds begin = now();
  // What really passed between two looks at the hand, not between two deadlines.
  const Nanoseconds sinceLast = lastBegin == 0 ? kPeriodNs : begin - lastBegin;
  lastBegin = begin;
  HandleInput handle;
  if (!device.readHandle(handle)) return false;
  parameters.update();
  ServoParameters limited = parameters.front();
  limited.limits = lower(limited.limits, deviceLimits);

  ServoSnapshot& snapshot = snapshots.back();
  tick.run(refresher->latest(), limited, handle, toSeconds(sinceLast), snapshot);
  device.sendWrench(snapshot.deviceWrench);

  snapshot.tick = ++statistics.ticks;
  refresher->report(
      {snapshot.proxy, searchReach(limited.haptics), snapshot.tick, snapshot.isWaiting, snapshot.isStarved});
  if (snapshot.lateBodies > 0) ++statistics.lateTicks;
  snapshot.time = toSeconds(sinceStart);
  snapshot.tickTime = toSeconds(now() - begin);
  statistics.tickTime.record(snapshot.tickTime);
  statistics.queryTime.record(snapshot.queryTime);
  if (record != nullptr) record->push(motionRow(snapshot));
  snapshots.publish();
  return true;
}

ServoLoop::ServoLoop() = default;

ServoLoop::~ServoLoop() {
  stop();
}

void ServoLoop::start(HapticDevice& device, std::unique_ptr<const ServoScene> scene,
                      const ServoParameters& parameters, MotionQueue* record) {
  if (shared_ && shared_->isJoinable) throw UsageError("servo", "it is running already", "stop it first");
  if (!scene) throw UsageError("servo", "there is no scene to feel", "open one first");
  const RigidTransform worldFromPart = scene->moving.worldFromPart;
  auto shared = std::make_unique<Shared>(device, std::move(scene), parameters, record);
  device.start(worldFromPart);
  try {
    shared->refresher->start();
    shared->spawn();
  } catch (...) {
    device.stop();
    throw;
  }
  shared_ = std::move(shared);
}

void ServoLoop::stop() noexcept {
  if (!shared_ || !shared_->isJoinable) return;
  shared_->stopRequested.store(true, std::memory_order_release);
  ::pthread_join(shared_->thread, nullptr);
  shared_->isJoinable = false;
  shared_->memoryLock.reset();
  shared_->lastRefreshTimes = shared_->refresher->refreshTimes();
  shared_->refresher.reset();
  shared_->device.stop();
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
