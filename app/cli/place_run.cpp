#include "app/cli/place_run.h"

#include <atomic>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>
#include <signal.h>

#include "core/haptics/scene_tracker.h"
#include "device/servo_loop.h"
#include "device/simulated_device.h"

namespace nearfit::cli {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers may touch nothing else");

void onInterrupt(int) {
  interrupted.store(true);
}

/// Turns the first interrupt into a flag; the second one kills as usual.
class InterruptGuard {
 public:
  InterruptGuard() {
    interrupted.store(false);
    struct sigaction action {};
    action.sa_handler = onInterrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(SIGINT, &action, &oldInt_);
    ::sigaction(SIGTERM, &action, &oldTerm_);
  }
  ~InterruptGuard() {
    ::sigaction(SIGINT, &oldInt_, nullptr);
    ::sigaction(SIGTERM, &oldTerm_, nullptr);
  }
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  struct sigaction oldInt_ {
  }, oldTerm_{};
};

void raise(Peak& peak, const glm::dvec3& vector, double time) {
  const double length = glm::length(vector);
  if (length > peak.value) peak = {length, time};
}

void take(const MotionRow& row, PlaceResult& result, MotionWriter* writer) {
  if (writer != nullptr) writer->write(row);
  result.clampedTicks += row.isClamped ? 1 : 0;
  result.lateTicks += row.lateBodies > 0 ? 1 : 0;
  result.truncatedTicks += row.isTruncated ? 1 : 0;
  result.maxLmds = std::max(result.maxLmds, row.lmds);
  if (row.distance < result.leastDistance) {
    result.leastDistance = row.distance;
    result.leastDistanceTime = row.time;
  }
  raise(result.force, row.wrench.force, row.time);
  raise(result.torque, row.wrench.torque, row.time);
  result.maxEnergyToHand = std::max(result.maxEnergyToHand, row.energyToHand);
  result.maxSubSteps = std::max(result.maxSubSteps, row.subSteps);
  result.shortenedSteps += row.shortenedSteps;
  result.refusedSteps += row.refusedSteps;
  result.releasedTicks += row.released > 0 ? 1 : 0;
  result.proxyTime.record(row.proxyTime);
  if (result.fault == ServoFault::None) result.fault = row.fault;
}

void takeLast(const ServoSnapshot& snapshot, PlaceResult& result) {
  result.end = snapshot.proxy;
  result.coupling = snapshot.coupling;
}

PlaceResult beginning(const PlaceJob& job) {
  PlaceResult result;
  result.leastDistance = std::numeric_limits<double>::infinity();
  result.end = job.scene->moving.worldFromPart;
  return result;
}

}  // namespace

PlaceResult placeFast(PlaceJob job) {
  using Clock = std::chrono::steady_clock;
  const InterruptGuard guard;
  PlaceResult result = beginning(job);
  PathDevice device(std::move(job.path));
  SceneTracker tracker;
  tracker.setScene(std::move(job.scene));
  TrackedScene tracked;
  ServoTick tick;
  const auto snapshot = std::make_unique<ServoSnapshot>();
  HandleInput handle;
  const SearchReach reach = searchReach(job.parameters.haptics);
  const bool isProxy = job.parameters.haptics.mode == HapticMode::Proxy;
  device.start(result.end);
  while (!interrupted.load() && device.readHandle(handle)) {
    // No thread beside: what is due is looked at before the tick, around where the part is; with springs that
    // is where the hand wants it, and nothing is late.
    tracker.observe(isProxy ? result.end : handle.pose, 1.0);
    tracker.setWaiting(snapshot->isWaiting);
    tracker.setStarved(snapshot->isStarved);
    if (result.ticks == 0 || tracker.isDue(reach)) {
      const Clock::time_point begin = Clock::now();
      tracker.refresh(reach, tracked);
      result.refreshTime.record(std::chrono::duration<double>(Clock::now() - begin).count());
    }
    const Clock::time_point begin = Clock::now();
    tick.run(tracked, job.parameters, handle, ServoLoop::kPeriod, *snapshot);
    device.sendWrench(snapshot->deviceWrench);
    snapshot->tickTime = std::chrono::duration<double>(Clock::now() - begin).count();
    snapshot->time = static_cast<double>(result.ticks) * ServoLoop::kPeriod;
    snapshot->tick = ++result.ticks;
    result.queryTime.record(snapshot->queryTime);
    result.tickTime.record(snapshot->tickTime);
    takeLast(*snapshot, result);
    take(motionRow(*snapshot), result, job.writer);
  }
  result.isInterrupted = device.state() == DeviceState::Running;
  device.stop();
  return result;
}

PlaceResult placeInRealTime(PlaceJob job) {
  const InterruptGuard guard;
  PlaceResult result = beginning(job);
  PathDevice device(std::move(job.path));
  const auto rows = std::make_unique<MotionQueue>();
  const auto takeRows = [&] {
    for (MotionRow row; rows->pop(row);)
      take(row, result, job.writer);
  };
  ServoLoop loop;
  loop.start(device, std::move(job.scene), job.parameters, rows.get());
  while (loop.isRunning() && !interrupted.load()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    takeRows();
  }
  // The path may end at the very moment of the interrupt: the device knows.
  result.isInterrupted = interrupted.load() && device.state() == DeviceState::Running;
  loop.stop();
  takeRows();
  result.lostRows = rows->dropped();
  if (loop.pollSnapshot()) takeLast(loop.snapshot(), result);
  const ServoStatistics statistics = loop.statistics();
  result.ticks = statistics.ticks;
  result.overruns = statistics.overruns;
  result.lateness = statistics.lateness;
  result.queryTime = statistics.queryTime;
  result.tickTime = statistics.tickTime;
  result.refreshTime = statistics.refreshTime;
  result.schedulingNote = loop.schedulingNote();
  return result;
}

}  // namespace nearfit::cli
