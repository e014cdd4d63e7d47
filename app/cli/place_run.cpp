#include "app/cli/place_run.h"

#include <chrono>
#include <cstddef>
#include <limits>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>

#include "app/cli/device_armer.h"
#include "app/cli/interrupt.h"
#include "core/base/error.h"
#include "core/servo/path_run.h"
#include "device/servo/servo_loop.h"
#include "device/simulated/simulated_device.h"
#include "device/thread/monotonic_clock.h"

namespace nearfit::cli {
namespace {

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
  result.maxAreas = std::max(result.maxAreas, row.areas);
  result.heldTicks += row.springShares.isHeld() ? 1 : 0;
  result.leastShares = {std::min(result.leastShares.wrench, row.springShares.wrench),
                        std::min(result.leastShares.damping, row.springShares.damping)};
  if (row.distance < result.leastDistance) {
    result.leastDistance = row.distance;
    result.isLeastDistanceBound = row.isDistanceBound;
    result.leastDistanceTime = row.time;
  }
  raise(result.force, row.wrench.force, row.time);
  raise(result.torque, row.wrench.torque, row.time);
  result.maxEnergyToHand = std::max(result.maxEnergyToHand, row.energyToHand);
  result.maxSubSteps = std::max(result.maxSubSteps, row.subSteps);
  result.shortenedSteps += row.shortenedSteps;
  result.refusedSteps += row.refusedSteps;
  result.overlappingTicks += row.overlapping > 0 ? 1 : 0;
  result.proxyTime.record(row.proxyTime);
  result.wrenchTime.record(row.wrenchTime);
  result.behindTicks += row.isBehind ? 1 : 0;
  if (result.fault == ServoFault::None) result.fault = row.fault;
}

void takeLast(const ServoSnapshot& snapshot, PlaceResult& result) {
  result.end = snapshot.proxy;
  result.coupling = snapshot.coupling;
  result.period = snapshot.period;
}

PlaceResult beginning(const PlaceJob& job) {
  PlaceResult result;
  result.leastDistance = std::numeric_limits<double>::infinity();
  result.end = job.scene->moving.worldFromPart;
  result.period = ServoLoop::kPeriod;
  return result;
}

/// Runs the servo on its own thread and takes its rows on this one.
class RecordedServo {
 public:
  RecordedServo(PlaceResult& result, MotionWriter* writer) : result_(result), writer_(writer) {}

  ServoLoop& loop() noexcept { return loop_; }
  MotionQueue* rows() noexcept { return rows_.get(); }
  void waitAndTake() {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    // Where rows come faster than they are written, taking all of them would have no end, and the run with it.
    constexpr std::size_t kRowsAtOnce = 1000;
    takeRows(kRowsAtOnce);
  }
  /// Stops the servo and takes the rows that are left.
  void finish() {
    loop_.stop();
    takeRows(std::numeric_limits<std::size_t>::max());
    result_.lostRows = rows_->dropped();
    if (loop_.pollSnapshot()) takeLast(loop_.snapshot(), result_);
    const ServoStatistics statistics = loop_.statistics();
    result_.ticks = statistics.ticks;
    result_.overruns = statistics.overruns;
    result_.lateness = statistics.lateness;
    result_.queryTime = statistics.queryTime;
    result_.tickTime = statistics.tickTime;
    result_.refreshTime = statistics.refreshTime;
    result_.schedulingNote = loop_.schedulingNote();
  }

 private:
  void takeRows(std::size_t atMost) {
    MotionRow row;
    for (std::size_t taken = 0; taken < atMost && rows_->pop(row); ++taken)
      take(row, result_, writer_);
  }

  PlaceResult& result_;
  MotionWriter* writer_;
  std::unique_ptr<MotionQueue> rows_ = std::make_unique<MotionQueue>();
  ServoLoop loop_;
};

/// Keeps a device open while this lives.
class OpenDevice {
 public:
  /// Opens the device; an interrupt cancels that. Throws Error, Cancelled.
  OpenDevice(HapticDevice& device, const RigidTransform& worldFromPart) : device_(device) {
    device.start(worldFromPart, [](double) { return !InterruptGuard::isInterrupted(); });
  }
  ~OpenDevice() { device_.stop(); }
  OpenDevice(const OpenDevice&) = delete;
  OpenDevice& operator=(const OpenDevice&) = delete;

 private:
  HapticDevice& device_;
};

/// Returns why the device stopped; empty while all is well.
std::string deviceTrouble(const HapticDevice& device) {
  const DeviceState state = device.state();
  return state == DeviceState::Lost || state == DeviceState::Fault ? device.stateNote() : std::string();
}

bool isOver(const PlaceJob& job, Nanoseconds begin) {
  return job.seconds && toSeconds(monotonicNow() - begin) >= *job.seconds;
}

}  // namespace

PlaceResult placeFast(PlaceJob job) {
  const InterruptGuard guard;
  PlaceResult result = beginning(job);
  const auto takeTick = [&](const PathTick& tick) {
    if (tick.refreshTime) result.refreshTime.record(*tick.refreshTime);
    result.queryTime.record(tick.snapshot.queryTime);
    result.tickTime.record(tick.snapshot.tickTime);
    takeLast(tick.snapshot, result);
    take(motionRow(tick.snapshot), result, job.writer);
    return !InterruptGuard::isInterrupted();
  };
  result.ticks = runAlongPath(std::move(job.scene), job.parameters, job.path, ServoLoop::kPeriod, takeTick);
  result.isInterrupted = result.ticks < job.path.size();
  return result;
}

PlaceResult placeInRealTime(PlaceJob job) {
  const InterruptGuard guard;
  PlaceResult result = beginning(job);
  PathDevice device(std::move(job.path));
  RecordedServo servo(result, job.writer);
  servo.loop().start(device, std::move(job.scene), job.parameters, servo.rows());
  while (servo.loop().isRunning() && !InterruptGuard::isInterrupted())
    servo.waitAndTake();
  // The path may end at the moment of the interrupt: the device knows.
  result.isInterrupted = InterruptGuard::isInterrupted() && device.state() == DeviceState::Armed;
  servo.finish();
  return result;
}

PlaceResult placeWithDevice(PlaceJob job) {
  const InterruptGuard guard;
  PlaceResult result = beginning(job);
  HapticDevice& device = *job.device;
  DeviceReport& report = result.device.emplace();
  if (!device.info().isMapped) job.parameters.haptics.mapping = {};
  const OpenDevice open(device, result.end);
  RecordedServo servo(result, job.writer);
  servo.loop().startWithOpen(device, std::move(job.scene), job.parameters, servo.rows());
  if (job.isCalibrating) device.calibrate();
  // Its limits are known only now that it is open.
  const DeviceInfo info = device.info();
  report.name = info.name;
  report.limits = job.parameters.limits = info.limits;
  servo.loop().setParameters(job.parameters);
  const Nanoseconds begin = monotonicNow();
  DeviceArmer armer(device, job.isArming);
  while (servo.loop().isRunning() && !InterruptGuard::isInterrupted() && !isOver(job, begin)) {
    report.trouble = armer.poll();
    if (report.trouble.empty()) report.trouble = deviceTrouble(device);
    if (!report.trouble.empty()) break;
    servo.waitAndTake();
  }
  if (report.trouble.empty()) report.trouble = deviceTrouble(device);
  report.seconds = toSeconds(monotonicNow() - begin);
  report.wasArmed = armer.hasArmed();
  report.counters = device.counters();
  servo.finish();
  report.roundTrip = servo.loop().statistics().roundTrip;
  return result;
}

}  // namespace nearfit::cli
