#include "app/cli/device_test_steps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "app/cli/interrupt.h"
#include "device/interface/device_supervisor.h"

namespace nearfit::cli {
namespace {

constexpr double kWatchSeconds = 2.0, kPushSeconds = 1.0;
/// The servo copes with half the nominal rate, with softer contact; less means a bad cable or hub.
constexpr double kMinRate = 0.5;
/// Shortest time over which speed is measured, since two reports may come at once [s].
constexpr double kSpeedTime = 0.01;
/// Limits for half a newton on a handle that is held.
constexpr double kMaxWay = 0.05, kMaxSpeed = 0.5;  // [m], [m/s]

using Result = TestStep::Result;

/// Measures the speed of a handle from its poses.
class SpeedMeter {
 public:
  /// Returns the speed [m/s]; the last one if too little time has passed.
  double see(const glm::dvec3& position, Nanoseconds now) noexcept {
    const double time = toSeconds(now - time_);
    if (time_ == 0 || time >= kSpeedTime) {
      if (time_ != 0) speed_ = glm::length(position - position_) / time;
      position_ = position;
      time_ = now;
    }
    return speed_;
  }

 private:
  glm::dvec3 position_{0.0};
  Nanoseconds time_ = 0;
  double speed_ = 0.0;
};

struct Watched {
  double seconds = 0.0, rate = 0.0, mostSpeed = 0.0;
  bool isLost = false, isFinite = true;
  ReportCounters counters;
};

Watched watchTicks(TickedDevice& ticked) {
  Watched watched;
  const ReportCounters before = ticked.device().counters();
  SpeedMeter speed;
  const Nanoseconds begin = monotonicNow();
  while (watched.seconds < kWatchSeconds && !InterruptGuard::isInterrupted()) {
    if (!ticked.tick()) {
      watched.isLost = true;
      break;
    }
    const Nanoseconds now = monotonicNow();
    const RigidTransform& pose = ticked.handle().pose;
    watched.isFinite = watched.isFinite && pose.isFinite();
    // std::fmax ignores NaN; isFinite reports it.
    watched.mostSpeed = std::fmax(watched.mostSpeed, speed.see(pose.translation, now));
    watched.seconds = toSeconds(now - begin);
  }
  const ReportCounters after = ticked.device().counters();
  watched.counters = {after.poses - before.poses, after.rejected - before.rejected,
                      after.missing - before.missing};
  if (watched.seconds > 0.0) watched.rate = static_cast<double>(watched.counters.poses) / watched.seconds;
  return watched;
}

TestStep judgeRate(const TickedDevice& ticked, const Watched& watched, double period,
                   const std::string& note) {
  TestStep step{"reports", Result::Passed, {}};
  const LatencyHistogram& intervals = ticked.meter().intervals();
  step.text = fmt::format("{:.1f} Hz, interval p50 {:.2f} and p99 {:.2f} ms, {} missing, {} rejected",
                          watched.rate, 1e3 * intervals.percentile(0.5), 1e3 * intervals.percentile(0.99),
                          watched.counters.missing, watched.counters.rejected);
  if (watched.isLost) return {"reports", Result::Failed, note};
  if (period <= 0.0) {
    step.text += watched.counters.poses == 0 ? " (it sends only while it is pushed)" : "";
    return step;
  }
  step.text += fmt::format("; its nominal rate is {:.1f} Hz", 1.0 / period);
  const bool isTooSlow = watched.rate < kMinRate / period;
  if (isTooSlow || watched.counters.rejected > watched.counters.poses) step.result = Result::Failed;
  return step;
}

TestStep judgePoses(const Watched& watched) {
  if (!watched.isFinite) return {"poses", Result::Failed, "a pose is not finite"};
  const bool isTooFast = !(watched.mostSpeed <= SafetyLimits{}.faultSpeed);
  return {
      "poses", isTooFast ? Result::Failed : Result::Passed,
      fmt::format("finite, max {:.3f} m/s{}", watched.mostSpeed, isTooFast ? ": faster than any hand" : "")};
}

/// Returns why a push is given up; empty if it goes on.
std::string motionTrouble(const HapticDevice& device, double way, double speed) {
  if (InterruptGuard::isInterrupted()) return "interrupted";
  if (device.state() != DeviceState::Armed) {
    const std::string note = device.stateNote();
    return note.empty() ? "it is no longer armed" : note;
  }
  if (!(way <= kMaxWay)) return fmt::format("the handle moved {:.3f} m: hold it", way);
  if (!(speed <= kMaxSpeed)) return fmt::format("the handle ran away at {:.2f} m/s", speed);
  return {};
}

}  // namespace

std::vector<TestStep> watchReports(TickedDevice& ticked) {
  const Watched watched = watchTicks(ticked);
  const HapticDevice& device = ticked.device();
  return {judgeRate(ticked, watched, device.info().reportPeriod, device.stateNote()), judgePoses(watched)};
}

TestStep push(TickedDevice& ticked, const std::string& name, const glm::dvec3& axis, double force) {
  const glm::dvec3 from = ticked.handle().pose.translation;
  SpeedMeter speed;
  double mostWay = 0.0;
  std::uint64_t ticks = 0, held = 0;
  const Nanoseconds begin = monotonicNow();
  for (double time = 0.0; time < kPushSeconds; time = toSeconds(monotonicNow() - begin)) {
    const double share = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * time / kPushSeconds);
    if (!ticked.tick(Wrench{share * force * axis, glm::dvec3(0.0)}))
      return {name, Result::Failed, ticked.device().stateNote()};
    const glm::dvec3& position = ticked.handle().pose.translation;
    const double way = glm::length(position - from);
    const std::string trouble = motionTrouble(ticked.device(), way, speed.see(position, monotonicNow()));
    if (!trouble.empty()) {
      ticked.tick();
      return {name, Result::Failed, trouble};
    }
    mostWay = std::max(mostWay, way);
    ++ticks;
    held += ticked.handle().isArmed ? 1 : 0;
  }
  ticked.tick();
  if (2 * held < ticks) return {name, Result::Failed, "it exerted no force: hold its dead-man's switch"};
  return {name, Result::Passed,
          fmt::format("up to {:.2f} N, the handle moved up to {:.4f} m", force, mostWay)};
}

}  // namespace nearfit::cli
