// Mapper, coupling, passivity controller and conditioner as a tick strings them together, with a hand at the
// end of it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/haptics/free_motion.h"
#include "core/haptics/passivity_controller.h"
#include "core/haptics/period_meter.h"
#include "core/haptics/virtual_coupling.h"
#include "core/haptics/workspace_mapper.h"
#include "core/haptics/wrench_conditioner.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/simulated_hand.h"

namespace nearfit::haptic_chain_test {
namespace {

constexpr double kPeriod = 1e-3;
const MassMetric kMetric{{1, 0, 0, 0}, glm::dvec3(0.02), 0.04};
const glm::dvec3 kCentre(0.1, 0.2, 0.3);

/// A hand that moves a device along its x axis, which is the world's y; the part stops at y = 1 cm.
class Chain {
 public:
  /// @param knowsScale  Whether the coupling is reckoned with what the device is at the handle.
  Chain(double scale, bool knowsScale)
      : limits_(knowsScale ? limitsAtHandle({}, scale) : DeviceLimits{}), hand_(0.2, 1.0, 0.0, 0.0) {
    mapping_.scale = scale;
    mapping_.orientationOffset = glm::angleAxis(std::numbers::pi / 2.0, glm::dvec3(0, 0, 1));
    mapper_.engageAt({}, {});
    conditioner_.engage();
  }

  void tick(double push) {
    hand_.step(sent_.force.x + push, kPeriod);
    meter_.add(kPeriod);
    const RigidTransform device{{1, 0, 0, 0}, {hand_.position(), 0, 0}};
    const BodyMotion last = handle_;
    handle_.pose = mapper_.map(device, false, mapping_);
    handle_.twist.linear = (handle_.pose.translation - last.pose.translation) / kPeriod;
    const CouplingState coupling = boundedCoupling({}, limits_, kMetric, meter_.period());
    controller_.observe({held_, handle_.pose.translation - last.pose.translation, {}, kPeriod, {}, {}},
                        limits_, storedEnergy(coupling, kMetric, kCentre, handle_.pose, part_.pose, limits_));
    followHandle(coupling);
    Wrench wanted = limitedCoupling(coupling, kMetric, kCentre, handle_, part_, limits_).rendered;
    const Wrench extra = controller_.damping(limits_, kPeriod);
    paidTicks_ += extra.force != glm::dvec3(0.0);
    wanted.force += extra.force;
    held_ = conditioner_.condition(wanted, 0.0, kPeriod, limits_).wrench;
    sent_ = wrenchOnDevice(held_, mapping_);
  }

  double speed() const { return std::abs(hand_.velocity()); }
  const Wrench& sent() const { return sent_; }
  const BodyMotion& handle() const { return handle_; }
  const BodyMotion& part() const { return part_; }
  int paidTicks() const { return paidTicks_; }

 private:
  void followHandle(const CouplingState& coupling) {
    const BodyMotion last = part_;
    part_ = freeStep({}, coupling, kMetric, kCentre, handle_, part_, kPeriod);
    part_.pose.translation.y = std::min(part_.pose.translation.y, 0.01);
    part_.twist.linear = (part_.pose.translation - last.pose.translation) / kPeriod;
  }

  const DeviceLimits limits_;
  WorkspaceMapping mapping_;
  test::SimulatedHand hand_;
  PeriodMeter meter_;
  WorkspaceMapper mapper_;
  PassivityController controller_;
  WrenchConditioner conditioner_;
  BodyMotion handle_, part_;
  Wrench held_, sent_;
  int paidTicks_ = 0;
};

/// Fastest motion in the last second of a hand that waits out the ramp and then leans on the wall.
double lean(Chain& chain, double push) {
  for (int i = 0; i < 300; ++i)
    chain.tick(0.0);
  double fastest = 0.0;
  for (int i = 0; i < 8000; ++i) {
    chain.tick(push);
    if (i >= 7000) fastest = std::max(fastest, chain.speed());
  }
  return fastest;
}

TEST(HapticChain, HandComesToRestOnAWallThatCarriesItsPushAtAnyScale) {
  for (const double scale : {0.25, 1.0, 4.0}) {
    Chain chain(scale, true);
    EXPECT_LT(lean(chain, 2.0), 1e-4) << scale;
    EXPECT_NEAR(chain.sent().force.x, -2.0, 0.01) << scale;
    EXPECT_NEAR(chain.part().pose.translation.y, 0.01, 1e-15) << scale;
    EXPECT_EQ(chain.paidTicks(), 0) << scale;
  }
}

TEST(HapticChain, MagnifiedMotionIsUnstableIfTheDevicesOwnNumbersAreTaken) {
  Chain chain(4.0, false);
  EXPECT_GT(lean(chain, 2.0), 0.01);
}

TEST(HapticChain, FreeMotionIsExactlyFree) {
  Chain chain(1.0, true);
  for (int i = 0; i < 500; ++i) {
    chain.tick(0.02 * std::sin(0.05 * i) - 0.02);
    ASSERT_LT(chain.handle().pose.translation.y, 0.01);
    EXPECT_EQ(chain.sent().force, glm::dvec3(0.0));
    EXPECT_EQ(chain.sent().torque, glm::dvec3(0.0));
  }
}

TEST(HapticChain, TicksAllocateNothing) {
  Chain chain(4.0, true);
  test::resetAllocationCount();
  test::startCountingAllocations();
  lean(chain, 2.0);
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::haptic_chain_test
