// What workspace_mapper.h says of wrench and limits on the two sides of the mapping.
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/haptics/workspace_mapper.h"
#include "core/math/rotation_vector.h"
#include "tests/support/random_values.h"

namespace nearfit::device_at_handle_test {
namespace {

using std::numbers::pi;
using test::RandomValues;
const glm::dvec3 kZ(0, 0, 1);

TEST(WrenchOnDevice, IsTurnedBackAndFreedOfLockedAxes) {
  WorkspaceMapping mapping;
  mapping.orientationOffset = glm::angleAxis(pi / 2.0, kZ);  // Device x is world y, device y is world -x.
  const Wrench world{{1, 2, 3}, {4, 5, 6}};
  const Wrench all = wrenchOnDevice(world, mapping);
  EXPECT_NEAR(glm::distance(all.force, {2, -1, 3}), 0.0, 1e-14);
  EXPECT_NEAR(glm::distance(all.torque, {5, -4, 6}), 0.0, 1e-14);
  mapping.translationLocks = {true, false, false};
  mapping.rotationLocks = {false, true, true};
  const Wrench some = wrenchOnDevice(world, mapping);
  EXPECT_NEAR(glm::distance(some.force, {2, 0, 3}), 0.0, 1e-14);
  EXPECT_NEAR(glm::distance(some.torque, {0, -4, 0}), 0.0, 1e-14);
}

TEST(WrenchOnDevice, DoesTheWorkOfTheHandleOverTheScale) {
  RandomValues random(9);
  for (int i = 0; i < 100; ++i) {
    WorkspaceMapping mapping;
    mapping.scale = random.in(0.2, 5.0);
    mapping.orientationOffset = rotationOf(random.vector(3.0));
    mapping.translationLocks = {i % 2 == 0, i % 3 == 0, i % 5 == 0};
    mapping.rotationLocks = {i % 4 == 0, i % 3 == 0, i % 7 == 0};
    WorkspaceMapper mapper;
    mapper.engage({});
    const glm::dvec3 turn = random.vector(1e-7);  // So small that turns add as vectors.
    const RigidTransform device{rotationOf(turn), random.vector(1e-7)};
    const RigidTransform handle = mapper.map(device, false, mapping);
    const Wrench world{random.vector(5.0), random.vector(5.0)}, sent = wrenchOnDevice(world, mapping);
    const double work = glm::dot(sent.force, device.translation) + glm::dot(sent.torque, turn);
    const double workAtHandle =
        glm::dot(world.force, handle.translation) + glm::dot(world.torque, rotationVector(handle.rotation));
    EXPECT_NEAR(work * mapping.scale, workAtHandle, 1e-11);
  }
}

TEST(LimitsAtHandle, AreThoseThatTheDeviceKeepsOverTheMapping) {
  // Scale 4: the handle at 0.4 m/s and 2 rad/s is the device at 0.1 m/s and 2 rad/s.
  const DeviceLimits device;
  const DeviceLimits limits = limitsAtHandle(device, 4.0);
  WorkspaceMapping mapping;
  mapping.scale = 4.0;
  const Wrench damping{{-limits.damping * 0.4, 0, 0}, {0, -limits.rotationalDamping * 2.0, 0}};
  const Wrench felt = wrenchOnDevice(damping, mapping);
  EXPECT_NEAR(felt.force.x, -device.damping * 0.1, 1e-15);
  EXPECT_NEAR(felt.torque.y, -device.rotationalDamping * 2.0, 1e-15);
  const Wrench most = wrenchOnDevice({{limits.maxForce, 0, 0}, {limits.maxTorque, 0, 0}}, mapping);
  EXPECT_NEAR(most.force.x, device.maxForce, 1e-15);
  EXPECT_NEAR(most.torque.x, device.maxTorque, 1e-15);
  // Force for an acceleration: 4 m/s^2 at the handle are 1 m/s^2 at the device.
  EXPECT_NEAR(limits.leastMass * 4.0, device.leastMass * 1.0, 1e-15);
  EXPECT_NEAR(limits.leastInertia * 3.0 / 4.0, device.leastInertia * 3.0, 1e-18);
}

TEST(LimitsAtHandle, SenselessScaleCountsAsOne) {
  for (const double scale : {0.0, -2.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(limitsAtHandle({}, scale).damping, DeviceLimits{}.damping);
    EXPECT_EQ(limitsAtHandle({}, scale).maxTorque, DeviceLimits{}.maxTorque);
  }
}

}  // namespace
}  // namespace nearfit::device_at_handle_test
