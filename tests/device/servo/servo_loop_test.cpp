#include "device/servo/servo_loop.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "device/common/passive_device.h"
#include "device/simulated/simulated_device.h"
#include "device/thread/monotonic_clock.h"
#include "tests/support/eventually.h"
#include "tests/support/servo_fixtures.h"

namespace nearfit::servo_loop_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using test::eventually;

/// A hand that holds still, remembers what it was sent, and does what a test asks of it in its n-th tick.
class TestDevice final : public PassiveDevice {
 public:
  explicit TestDevice(const RigidTransform& pose) : pose_(pose) {}

  DeviceInfo info() const override { return {"Test", 6, limits, reportPeriod}; }
  DeviceState state() const noexcept override { return DeviceState::Armed; }
  std::string stateNote() const override { return {}; }
  ReportCounters counters() const noexcept override { return {}; }
  bool waitForHandle(Nanoseconds deadline) noexcept override {
    waitUntil(reportPeriod > 0.0 ? monotonicNow() + kNanosecondsPerSecond / 1000 : deadline);
    return reportPeriod > 0.0;
  }
  void start(const RigidTransform&, const ProgressCallback& = {}) override {
    if (failsToStart) throw Error("device", "it does not start");
    ++starts;
  }
  void stop() noexcept override { ++stops; }
  bool readHandle(HandleInput& handle) noexcept override {
    ++reads;
    handle = {.pose = pose_, .age = age};
    if (reads == slowTick) std::this_thread::sleep_for(slowness);
    if (reads == badTick) handle.pose.translation.x = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  void sendWrench(const Wrench& wrench) noexcept override {
    if (wrench.force.z != 0.0) largestForce = std::max(largestForce, wrench.force.z);
    last = wrench;
    ++sends;
  }

  // Set before start.
  DeviceLimits limits{100.0, 100.0};
  double reportPeriod = 0.0, age = 0.0;
  bool failsToStart = false;
  int slowTick = 0, badTick = 0;
  std::chrono::microseconds slowness{0};
  // Read after stop.
  int starts = 0, stops = 0, reads = 0, sends = 0;
  double largestForce = 0.0;
  Wrench last{{9.0, 9.0, 9.0}, {9.0, 9.0, 9.0}};

 private:
  RigidTransform pose_;
};

/// Ticks after which what is felt is felt in full, though some come a little early.
constexpr std::size_t kTicksOfRamp = 230;
static_assert(static_cast<double>(kTicksOfRamp) * ServoLoop::kPeriod > WrenchConditioner::kRampTime);

ServoParameters softSprings() {
  ServoParameters p;
  p.haptics.mode = HapticMode::Springs;
  p.haptics.springs = {.cutoff = 0.1, .stiffness = 50.0, .damping = 0.0, .law = SpringLaw::Linear};
  p.limits = {100.0, 100.0};
  return p;
}

bool hasTicked(ServoLoop& loop, std::uint64_t ticks) {
  return eventually([&] {
    loop.pollSnapshot();
    return loop.snapshot().tick >= ticks;
  });
}

TEST(ServoLoop, FeelsTheSceneAndSendsZeroLast) {
  TestDevice device(test::tipAt(0.04));
  ServoLoop loop;
  EXPECT_FALSE(loop.isRunning());
  loop.start(device, test::coneOverFloor(), softSprings());
  EXPECT_TRUE(loop.isRunning());
  ASSERT_TRUE(hasTicked(loop, kTicksOfRamp));
  EXPECT_NEAR(loop.snapshot().wrench.force.z, 50.0 * 0.06, 1e-9);
  EXPECT_EQ(loop.snapshot().moving, PartId{2});
  loop.stop();
  EXPECT_FALSE(loop.isRunning());
  EXPECT_NEAR(device.largestForce, 3.0, 1e-9);
  EXPECT_EQ(device.last.force, glm::dvec3(0.0));
  EXPECT_EQ(device.last.torque, glm::dvec3(0.0));
  EXPECT_EQ(device.sends, device.reads + 1);
  EXPECT_EQ(device.starts, 1);
  EXPECT_EQ(device.stops, 1);
}

TEST(ServoLoop, RunsAtOneKilohertzOrSaysWhatItSkipped) {
  TestDevice device(test::tipAt(0.04));
  const auto rows = std::make_unique<MotionQueue>();
  ServoLoop loop;
  const Clock::time_point begin = Clock::now();
  loop.start(device, test::coneOverFloor(), softSprings(), rows.get());
  ASSERT_TRUE(hasTicked(loop, 400));
  loop.stop();
  const double elapsedMs = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  const ServoStatistics s = loop.statistics();
  EXPECT_EQ(s.ticks, static_cast<std::uint64_t>(device.reads));
  EXPECT_EQ(s.lateness.count(), s.ticks);
  EXPECT_EQ(s.tickTime.count(), s.ticks);
  EXPECT_EQ(s.queryTime.count(), s.ticks);
  MotionRow last;
  while (rows->pop(last)) {
  }
  const double periods = static_cast<double>(s.ticks + s.overruns);
  EXPECT_LE(periods, elapsedMs + 1.0) << "never faster";
  EXPECT_GE(periods, std::round(last.time / ServoLoop::kPeriod) + 1.0)
      << "every period to the last tick's is a tick or an overrun";
}

TEST(ServoLoop, ASlowTickSkipsWholePeriodsAndIsFollowedByNoBurst) {
  TestDevice device(test::tipAt(0.04));
  device.slowTick = 20;
  device.slowness = 7500us;
  const auto rows = std::make_unique<MotionQueue>();
  ServoLoop loop;
  loop.start(device, test::coneOverFloor(), softSprings(), rows.get());
  ASSERT_TRUE(hasTicked(loop, 60));
  loop.stop();
  EXPECT_GE(loop.statistics().overruns, 7U);
  std::vector<MotionRow> all;
  for (MotionRow row; rows->pop(row);)
    all.push_back(row);
  ASSERT_GE(all.size(), 60U);
  EXPECT_EQ(all.size(), loop.statistics().ticks);
  EXPECT_GE(all[20].time - all[19].time, 8e-3 - 1e-9);
  std::uint64_t skipped = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const double periods = (all[i].time - all[i - 1].time) / ServoLoop::kPeriod;
    EXPECT_NEAR(periods, std::round(periods), 1e-6) << "deadlines stay on the grid";
    EXPECT_GE(periods, 1.0 - 1e-6);
    skipped += static_cast<std::uint64_t>(std::lround(periods)) - 1;
  }
  EXPECT_LE(skipped, loop.statistics().overruns) << "the last tick may have skipped some too";
}

TEST(ServoLoop, ARoundTripGoesFromTheReportsArrivalToItsWrench) {
  TestDevice device(test::tipAt(0.04));
  device.reportPeriod = 1e-3;
  device.age = 3e-3;
  device.slowTick = 20;
  device.slowness = 8ms;
  ServoLoop loop;
  loop.start(device, test::coneOverFloor(), softSprings());
  ASSERT_TRUE(hasTicked(loop, 30));
  loop.stop();
  const ServoStatistics statistics = loop.statistics();
  EXPECT_EQ(statistics.roundTrip.count(), statistics.ticks);
  EXPECT_GE(statistics.roundTrip.percentile(0.0), device.age);
  EXPECT_GE(statistics.roundTrip.max(), device.age + 8e-3);
  EXPECT_GE(statistics.lateness.percentile(0.0), device.age);

  TestDevice paced(test::tipAt(0.04));
  loop.start(paced, test::coneOverFloor(), softSprings());
  ASSERT_TRUE(hasTicked(loop, 30));
  loop.stop();
  EXPECT_EQ(loop.statistics().roundTrip.count(), 0U);
}

TEST(ServoLoop, EndsByItselfWithTheDevice) {
  std::vector<RigidTransform> path(kTicksOfRamp, test::tipAt(0.03));
  path.insert(path.end(), {test::tipAt(0.02), test::tipAt(0.04)});
  PathDevice device(path);
  const auto rows = std::make_unique<MotionQueue>();
  ServoLoop loop;
  loop.start(device, test::coneOverFloor(), softSprings(), rows.get());
  ASSERT_TRUE(eventually([&] { return !loop.isRunning(); }));
  loop.stop();
  EXPECT_EQ(loop.statistics().ticks, path.size());
  EXPECT_EQ(device.lastWrench().force, glm::dvec3(0.0));
  const double expected[] = {3.5, 4.0, 3.0};
  MotionRow row;
  for (std::size_t i = 1; i < kTicksOfRamp; ++i)
    ASSERT_TRUE(rows->pop(row));
  for (const double force : expected) {
    ASSERT_TRUE(rows->pop(row));
    EXPECT_NEAR(row.wrench.force.z, force, 1e-9);
  }
  EXPECT_FALSE(rows->pop(row));
  EXPECT_TRUE(loop.pollSnapshot());
  EXPECT_EQ(loop.snapshot().tick, path.size());
  EXPECT_NEAR(loop.snapshot().proxy.translation.z, 0.04, 1e-15);
}

TEST(ServoLoop, TheLowerOfDeviceAndParameterLimitsHolds) {
  TestDevice device(test::tipAt(0.04));
  device.limits = {1.0, 100.0};
  ServoLoop loop;
  loop.start(device, test::coneOverFloor(), softSprings());
  ASSERT_TRUE(hasTicked(loop, kTicksOfRamp));
  EXPECT_NEAR(loop.snapshot().wrench.force.z, 1.0, 1e-12);
  ServoParameters lower = softSprings();
  lower.limits.maxForce = 0.5;
  loop.setParameters(lower);
  EXPECT_TRUE(eventually([&] {
    loop.pollSnapshot();
    return std::abs(loop.snapshot().wrench.force.z - 0.5) < 1e-12;
  }));
  EXPECT_TRUE(loop.snapshot().isClamped);
}

TEST(ServoLoop, ParametersChangeWhileItRuns) {
  TestDevice device(test::tipAt(0.5));
  ServoLoop loop;
  loop.start(device, test::coneOverFloor(), softSprings());
  ASSERT_TRUE(hasTicked(loop, 2));
  EXPECT_EQ(loop.snapshot().distance, std::numeric_limits<double>::infinity());
  ServoParameters wide = softSprings();
  wide.haptics.springs.cutoff = 0.6;
  loop.setParameters(wide);
  EXPECT_TRUE(eventually([&] {
    loop.pollSnapshot();
    return std::abs(loop.snapshot().distance - 0.5) < 1e-9;
  }));
}

TEST(ServoLoop, APoseThatIsNoNumberSilencesItUntilItIsStartedAnew) {
  TestDevice device(test::tipAt(0.04));
  device.badTick = 5;
  ServoLoop loop;
  loop.start(device, test::coneOverFloor(), softSprings());
  ASSERT_TRUE(hasTicked(loop, 20));
  EXPECT_EQ(loop.snapshot().fault, ServoFault::PoseNotFinite);
  EXPECT_EQ(loop.snapshot().wrench.force, glm::dvec3(0.0));
  loop.stop();
  loop.start(device, test::coneOverFloor(), softSprings());
  ASSERT_TRUE(hasTicked(loop, kTicksOfRamp));
  EXPECT_EQ(loop.snapshot().fault, ServoFault::None);
  EXPECT_NEAR(loop.snapshot().wrench.force.z, 3.0, 1e-9);
}

TEST(ServoLoop, AManualPoseIsFollowed) {
  ManualDevice device;
  ServoLoop loop;
  loop.start(device, test::coneOverFloor(), softSprings());
  ASSERT_TRUE(hasTicked(loop, 2));
  EXPECT_NEAR(loop.snapshot().proxy.translation.z, 0.5, 1e-15) << "starts where the scene has the part";
  device.setPose(test::tipAt(0.05));
  EXPECT_TRUE(eventually([&] {
    loop.pollSnapshot();
    return std::abs(loop.snapshot().wrench.force.z - 2.5) < 1e-9;
  }));
}

TEST(ServoLoop, MisuseIsRefusedAndChangesNothing) {
  TestDevice device(test::tipAt(0.04));
  ServoLoop loop;
  loop.stop();
  loop.setScene(test::coneOverFloor());
  loop.setParameters(softSprings());
  EXPECT_FALSE(loop.pollSnapshot());
  EXPECT_EQ(loop.snapshot().tick, 0U);
  EXPECT_EQ(loop.statistics().ticks, 0U);
  EXPECT_THROW(loop.start(device, nullptr, softSprings()), UsageError);
  loop.start(device, test::coneOverFloor(), softSprings());
  EXPECT_THROW(loop.start(device, test::coneOverFloor(), softSprings()), UsageError);
  EXPECT_THROW(loop.setScene(nullptr), UsageError);
  EXPECT_TRUE(loop.isRunning());
  EXPECT_TRUE(hasTicked(loop, 2));
  loop.stop();
  loop.stop();
  loop.setScene(test::coneOverFloor());
  EXPECT_EQ(device.stops, 1);
}

TEST(ServoLoop, ADeviceThatDoesNotStartLeavesItStopped) {
  TestDevice device(test::tipAt(0.04));
  device.failsToStart = true;
  ServoLoop loop;
  EXPECT_THROW(loop.start(device, test::coneOverFloor(), softSprings()), Error);
  EXPECT_FALSE(loop.isRunning());
  device.failsToStart = false;
  loop.start(device, test::coneOverFloor(), softSprings());
  EXPECT_TRUE(hasTicked(loop, 2));
}

TEST(ServoLoop, DestructionWhileRunningStopsIt) {
  TestDevice device(test::tipAt(0.04));
  {
    ServoLoop loop;
    loop.start(device, test::coneOverFloor(), softSprings());
    ASSERT_TRUE(hasTicked(loop, 2));
  }
  EXPECT_EQ(device.stops, 1);
  EXPECT_EQ(device.last.force, glm::dvec3(0.0));
}

TEST(ServoLoop, SaysWhatSchedulingItGotAndWhatToDoWhenItGotNone) {
  TestDevice device(test::tipAt(0.04));
  ServoLoop loop;
  loop.start(device, test::coneOverFloor(), softSprings());
  const std::string note = loop.schedulingNote();
  const bool isGranted = note == "SCHED_FIFO 70, memory locked";
  const bool hasRemedy = note.find("limits.d") != std::string::npos && note.find('(') != std::string::npos;
  EXPECT_TRUE(isGranted || hasRemedy) << note;
}

}  // namespace
}  // namespace nearfit::servo_loop_test
