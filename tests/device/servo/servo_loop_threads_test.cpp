#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "device/common/passive_device.h"
#include "device/servo/servo_loop.h"
#include "device/simulated/simulated_device.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/servo_fixtures.h"

namespace nearfit::servo_loop_threads_test {
namespace {

using namespace std::chrono_literals;

ServoParameters softSprings() {
  ServoParameters p;
  p.haptics.springs = {.cutoff = 0.1, .stiffness = 50.0, .damping = 1.0, .law = SpringLaw::Linear};
  p.limits = {100.0, 100.0};
  return p;
}

/// Has the heap watched in the servo thread, from its first tick until the thread is gone.
class WatchedDevice final : public PassiveDevice {
 public:
  DeviceInfo info() const override { return {"Watched", 6, {100.0, 100.0}}; }
  DeviceState state() const noexcept override { return DeviceState::Armed; }
  std::string stateNote() const override { return {}; }
  ReportCounters counters() const noexcept override { return {}; }
  bool waitForHandle(Nanoseconds deadline) noexcept override {
    waitUntil(deadline);
    return false;
  }
  void start(const RigidTransform&, const ProgressCallback& = {}) override {}
  void stop() noexcept override {}
  bool readHandle(HandleInput& handle) noexcept override {
    test::startCountingAllocations();
    servoThread.store(std::this_thread::get_id());
    handle = {.pose = test::tipAt(0.03 + 0.02 * std::sin(0.05 * ++ticks))};
    return ticks < lastTick;
  }
  void sendWrench(const Wrench&) noexcept override {}

  std::atomic<std::thread::id> servoThread{};
  int lastTick = 1'000'000'000;
  int ticks = 0;
};

/// Counts scenes that are freed, by means of a geometry that only they hold.
struct FreedScenes {
  explicit FreedScenes(const WatchedDevice& watched) : device(watched) {}

  const WatchedDevice& device;
  std::atomic<int> onServoThread{0}, elsewhere{0};

  std::unique_ptr<ServoScene> make(std::uint32_t bodies) {
    auto scene = test::coneOverFloor();
    const ServoScene::Body floor = scene->bodies[0];
    scene->bodies.clear();
    for (std::uint32_t i = 0; i < bodies; ++i)
      scene->bodies.push_back({PartId{10 + i}, floor.geometry, {}});
    const PartGeometryPtr cone = scene->moving.geometry;
    scene->moving.geometry = PartGeometryPtr(cone.get(), [this, cone](const PartGeometry*) {
      (std::this_thread::get_id() == device.servoThread.load() ? onServoThread : elsewhere).fetch_add(1);
    });
    return scene;
  }
};

TEST(ServoLoopThreads, PartsComeAndGoByTheThousandAndAreFreedOffTheServoThread) {
  constexpr int kSwaps = 4000;
  WatchedDevice device;
  FreedScenes freed(device);
  {
    ServoLoop loop;
    loop.start(device, freed.make(1), softSprings());
    std::uint64_t lastTick = 0;
    int swaps = 0;
    for (int i = 0; i < kSwaps || lastTick <= 100; ++i, ++swaps) {
      loop.setScene(freed.make(static_cast<std::uint32_t>(i % 4)));
      if (i % 5 == 0) std::this_thread::sleep_for(1200us);
      if (i % 7 == 0) loop.setParameters(softSprings());
      if (loop.pollSnapshot()) {
        const ServoSnapshot& s = loop.snapshot();
        EXPECT_GT(s.tick, lastTick);
        EXPECT_LE(s.lmdCount, 3U);
        lastTick = s.tick;
      }
      const ServoStatistics statistics = loop.statistics();
      EXPECT_EQ(statistics.lateness.count(), statistics.ticks) << "taken whole";
    }
    EXPECT_TRUE(loop.isRunning());
    EXPECT_GT(lastTick, 100U);
    EXPECT_GT(freed.elsewhere.load(), swaps / 2) << "freed as it goes, not hoarded";
    loop.stop();
    EXPECT_EQ(freed.elsewhere.load(), swaps + 1) << "nothing of a stopped servo is kept";
  }
  EXPECT_EQ(freed.onServoThread.load(), 0);
}

TEST(ServoLoopThreads, AControllerThatNeverPollsLosesNoScene) {
  WatchedDevice device;
  FreedScenes freed(device);
  {
    ServoLoop loop;
    loop.start(device, freed.make(1), softSprings());
    for (int i = 0; i < 100; ++i) {
      loop.setScene(freed.make(1));
      std::this_thread::sleep_for(2ms);
    }
  }
  EXPECT_EQ(freed.elsewhere.load(), 101);
  EXPECT_EQ(freed.onServoThread.load(), 0);
}

TEST(ServoLoopThreads, TheServoThreadAsksNothingOfTheHeapToItsVeryEnd) {
  for (const bool endsByItself : {false, true}) {
    WatchedDevice device;
    if (endsByItself) device.lastTick = 300;
    const auto rows = std::make_unique<MotionQueue>();
    test::resetAllocationCount();
    ServoLoop loop;
    loop.start(device, test::coneOverFloor(), softSprings(), rows.get());
    for (int i = 0; i < 200 || (loop.isRunning() && loop.snapshot().tick <= 100); ++i) {
      loop.setScene(test::coneOverFloor());
      loop.setParameters(softSprings());
      loop.pollSnapshot();
      std::this_thread::sleep_for(2ms);
    }
    loop.stop();
    EXPECT_GT(loop.statistics().ticks, 100U);
    EXPECT_EQ(test::countedAllocations(), 0U);
    EXPECT_NE(device.servoThread.load(), std::this_thread::get_id());
  }
}

TEST(ServoLoopThreads, EveryTickIsRecordedOnceInOrder) {
  constexpr int kTicks = 1500;
  std::vector<RigidTransform> path;
  for (int i = 0; i < kTicks; ++i)
    path.push_back(test::tipAt(0.02 + 1e-5 * i));
  PathDevice device(path);
  const auto rows = std::make_unique<MotionQueue>();
  ServoLoop loop;
  loop.start(device, test::coneOverFloor(), softSprings(), rows.get());
  int next = 0;
  const auto takeRows = [&] {
    for (MotionRow row; rows->pop(row);)
      EXPECT_EQ(row.handle.translation.z, 0.02 + 1e-5 * next++);
  };
  while (loop.isRunning()) {
    std::this_thread::sleep_for(5ms);
    takeRows();
  }
  loop.stop();
  takeRows();
  EXPECT_EQ(next, kTicks);
  EXPECT_EQ(rows->dropped(), 0U);
}

TEST(ServoLoopThreads, StartingAndStoppingManyTimesIsClean) {
  WatchedDevice device;
  FreedScenes freed(device);
  ServoLoop loop;
  for (int i = 0; i < 50; ++i) {
    loop.start(device, freed.make(1), softSprings());
    if (i % 2 == 0) std::this_thread::sleep_for(2ms);
    loop.setScene(freed.make(2));
    loop.stop();
  }
  EXPECT_EQ(freed.elsewhere.load(), 100);
  EXPECT_EQ(freed.onServoThread.load(), 0);
}

}  // namespace
}  // namespace nearfit::servo_loop_threads_test
