#include <algorithm>
#include <memory>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "device/servo/servo_loop.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/usb/driver_fixture.h"

namespace nearfit::driver_proxy_test {
namespace {

using test::eventually;

/// A peg of 4 cm by 4 cm by 10 cm, its frame in its middle, in a corner: over the floor, whose top is z = 0,
/// and beside a wall, whose face is x = 0.03 [m].
constexpr glm::dvec3 kHalf{0.02, 0.02, 0.05}, kStart{0.0, 0.0, 0.06};
constexpr double kWall = 0.03;
/// To either it is 1 cm; the hand goes so far beyond [m].
constexpr double kGap = 0.01, kBeyond = 0.003;
/// Of the place where the handle is held, by encoders and floats [m].
constexpr double kHandSlack = 1e-4;
/// Of what the motors push with: whole milliamperes, and counts of the handle's place [N].
constexpr double kForceSlack = 0.1;

std::unique_ptr<ServoScene> pegInACorner() {
  static const PartGeometryPtr peg = test::geometryOf(test::boxMesh(2.0 * kHalf));
  static const PartGeometryPtr floor = test::geometryOf(test::boxMesh({2.0, 2.0, 1.0}, {0.0, 0.0, -0.5}));
  static const PartGeometryPtr wall =
      test::geometryOf(test::boxMesh({1.0, 2.0, 2.0}, {kWall + 0.5, 0.0, 0.5}));
  auto scene = std::make_unique<ServoScene>();
  scene->setMoving({PartId{3}, peg, {glm::dquat(1.0, 0.0, 0.0, 0.0), kStart}});
  scene->bodies.push_back({PartId{1}, floor, {}});
  scene->bodies.push_back({PartId{2}, wall, {}});
  return scene;
}

/// The servo in its usual mode, led by each device.
class DriverInProxyMode : public test::EachDriver {
 protected:
  /// As its user does: seen to once, then used by the servo.
  void begin() {
    if (pushes()) {
      bench->start(*device);
      bench->makeWell(*device);
      bench->holdAt(glm::dvec3(0.0));
      bench->stopStreaming();
      device->stop();
    }
    loop.start(*device, pegInACorner(), ServoParameters{}, record.get());
    bench->stream();
    ASSERT_TRUE(eventually([&] { return device->counters().poses > 20 || !pushes(); }));
    if (!pushes()) return;
    ASSERT_EQ(device->state(), DeviceState::Ready) << device->stateNote();
    device->arm();
  }
  /// The hand goes straight on, a tenth of a millimetre a report.
  void lead(const glm::dvec3& from, const glm::dvec3& to) {
    const int steps = std::max(1, static_cast<int>(glm::distance(from, to) / 1e-4));
    for (int i = 1; i <= steps; ++i) {
      bench->holdAt(from + (to - from) * (static_cast<double>(i) / steps));
      const std::uint64_t before = device->counters().poses;
      ASSERT_TRUE(test::promptly([&] { return device->counters().poses > before; })) << device->stateNote();
      takeRows();
    }
  }
  /// Often enough that none is dropped, however long a loaded machine takes for a way.
  void takeRows() {
    MotionRow row;
    while (record->pop(row)) {
      ++ticks;
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                              (corner & 4) != 0 ? 1.0 : -1.0);
        const glm::dvec3 at = row.proxy.translation + row.proxy.rotation * (sign * kHalf);
        lowest = std::min(lowest, at.z);
        farthest = std::max(farthest, at.x);
      }
    }
  }
  /// In no tick so far was a corner of the peg in the floor or in the wall.
  void expectNeverPassed() {
    takeRows();
    ASSERT_GT(lowest, 0.0) << "within " << ticks << " ticks";
    ASSERT_LT(farthest, kWall) << "within " << ticks << " ticks";
    ASSERT_EQ(record->dropped(), 0U);
  }
  const ServoSnapshot& snapshot() {
    takeRows();
    loop.pollSnapshot();
    return loop.snapshot();
  }
  void TearDown() override {
    loop.stop();
    bench->stopStreaming();
  }

  std::unique_ptr<MotionQueue> record = std::make_unique<MotionQueue>();
  std::uint64_t ticks = 0;
  double lowest = kStart.z, farthest = -kWall;  ///< Of all corners in all ticks: z, and x [m].
  ServoLoop loop;
};

TEST_P(DriverInProxyMode, APegIsHeldAtAWallAndTheHandFeelsIt) {
  if (!pushes()) return;  // The next test.
  begin();
  const glm::dvec3 corner{kGap + kBeyond, 0.0, -kGap - kBeyond};
  lead({}, corner);
  // The spring between the hand, which is held, and the peg, which stands off by the margin.
  const double margin = ProxySettings{}.margin;
  const auto isFelt = [&] {
    const ServoSnapshot& now = snapshot();
    const glm::dvec3 way = now.proxy.translation - now.handle.translation;
    const glm::dvec3 expected = now.coupling.stiffness * glm::dvec3(-kBeyond - margin, 0.0, kBeyond + margin);
    return glm::distance(way, {-kBeyond - margin, 0.0, kBeyond + margin}) < margin + kHandSlack &&
           glm::length(expected) > 10.0 * kForceSlack &&
           glm::distance(bench->force(), expected) < 2.0 * margin * now.coupling.stiffness + kForceSlack;
  };
  EXPECT_TRUE(eventually(isFelt)) << bench->force().x << " " << bench->force().y << " " << bench->force().z
                                  << " N at " << snapshot().coupling.stiffness << " N/m, "
                                  << device->stateNote();
  expectNeverPassed();
  // Along the corner and back, pushing all the time.
  lead(corner, corner + glm::dvec3(0.0, 0.01, 0.0));
  lead(corner + glm::dvec3(0.0, 0.01, 0.0), corner);
  expectNeverPassed();
  EXPECT_EQ(device->state(), DeviceState::Armed) << device->stateNote();
  // Where nothing is in the way nothing is felt, and the peg is where the hand is.
  lead(corner, {});
  EXPECT_TRUE(eventually([&] {
    return glm::length(bench->force()) < 1e-2 &&
           glm::distance(snapshot().proxy.translation, kStart) < kHandSlack;
  })) << glm::length(bench->force());
  expectNeverPassed();
  EXPECT_GT(ticks, 100U);
}

TEST_P(DriverInProxyMode, ASpaceMousePushesAPegNoFartherThanItsLeashAndBackAtOnce) {
  if (pushes()) return;  // The test before.
  begin();
  const auto drive = [&](std::int16_t down) {
    const auto endpoint = bench->traits().in;
    const auto low = static_cast<std::byte>(down & 0xff), high = static_cast<std::byte>(down >> 8 & 0xff);
    // X, Y and Z, of which Z is down.
    const test::Bytes report{std::byte{1}, {}, {}, {}, {}, low, high};
    return emulated().send(endpoint, report) != test::EmulatedDevice::Sending::NobodyAsked;
  };
  bench->stopStreaming();
  // The wrench, which nobody feels, slows the handle down as it nears 5 N, and so does it never get there.
  constexpr double kLeash = 5.0;
  ASSERT_TRUE(eventually([&] { return drive(350) && snapshot().wrench.force.z > 0.9 * kLeash; }));
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE(drive(350));
  EXPECT_LT(snapshot().wrench.force.z, 1.1 * kLeash) << "a few ticks' way beyond";
  const double deep = snapshot().handle.translation.z;
  EXPECT_LT(deep, kHalf.z);
  expectNeverPassed();
  ASSERT_TRUE(eventually([&] { return drive(-350) && snapshot().proxy.translation.z > kHalf.z + 0.005; }));
  expectNeverPassed();
}

INSTANTIATE_TEST_SUITE_P(All, DriverInProxyMode, testing::ValuesIn(test::kDriverKinds), test::nameOf);

}  // namespace
}  // namespace nearfit::driver_proxy_test
