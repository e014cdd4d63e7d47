// Each maker's plug-in over what stands in for the maker's driver: the plug-ins are those that ship.
#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "device/interface/device_supervisor.h"
#include "tests/makers/maker_bench.h"
#include "tests/support/eventually.h"
#include "tests/support/scoped_variable.h"

namespace nearfit::maker_plugin_test {
namespace {

using test::eventually;
using test::Maker;
using test::MakerModel;
using test::ScopedVariable;
using testing::HasSubstr;

glm::dvec3 vectorOf(const test::Triple& v) {
  return {v[0], v[1], v[2]};
}
bool isNear(const glm::dvec3& a, const glm::dvec3& b, double slack) {
  return glm::distance(a, b) <= slack;
}

class EachMaker : public testing::TestWithParam<MakerModel> {
 protected:
  void open(const SafetyLimits& safety = test::patientSafety()) {
    device = bench.make(0, safety);
    device->start({});
    servo.emplace(*device);
  }
  /// Its calibration is read from its driver, now and then.
  bool becomes(DeviceState state) {
    return eventually([&] { return device->state() == state; });
  }
  void arm() {
    ASSERT_TRUE(becomes(DeviceState::Ready)) << device->stateNote();
    device->arm();
  }
  void TearDown() override {
    servo.reset();
    device.reset();
  }

  test::MakerBench bench{GetParam()};
  std::unique_ptr<HapticDevice> device;
  std::optional<test::MakerServo> servo;
};

constexpr Wrench kPush{{0.5, 0.25, -1.0}, {0.01, -0.02, 0.03}};
/// The hand gives way to a push; encoders are exact here [m].
constexpr double kPlaceSlack = 1e-3;

TEST_P(EachMaker, IsListedWithWhatItSensesAndPushes) {
  const auto listed = bench.plugin()->devices();
  ASSERT_EQ(listed.size(), GetParam().maker == Maker::OpenHaptics ? 2U : 1U);
  open();
  const DeviceInfo info = device->info();
  EXPECT_EQ(info.sensedAxes, GetParam().sensedAxes);
  EXPECT_EQ(info.forceAxes, GetParam().forceAxes);
  EXPECT_DOUBLE_EQ(info.reportPeriod, 1.0 / GetParam().rate);
  EXPECT_DOUBLE_EQ(info.limits.maxForce, GetParam().maxForce);
  EXPECT_EQ(info.limits.maxTorque > 0.0, GetParam().forceAxes == 6);
  EXPECT_EQ(info.isTurningUnfelt(), GetParam().sensedAxes == 6 && GetParam().forceAxes == 3);
}

TEST_P(EachMaker, ItsHandleIsWhereTheHandHoldsIt) {
  open();
  const glm::dvec3 wanted{0.02, -0.03, 0.01};
  bench.device().target.set({wanted.x, wanted.y, wanted.z});
  constexpr double kTurn = 0.3;
  bench.device().turn = kTurn;
  const glm::dquat turned = GetParam().sensedAxes == 6 ? glm::angleAxis(kTurn, glm::dvec3(0.0, 1.0, 0.0))
                                                       : glm::dquat(1.0, 0.0, 0.0, 0.0);
  // Friction lets the handle rest a little off.
  EXPECT_TRUE(eventually([&] {
    const HandleInput handle = servo->last();
    return isNear(handle.pose.translation, wanted, 2.0 * kPlaceSlack) &&
           std::abs(glm::dot(handle.pose.rotation, turned)) > 1.0 - 1e-9;
  })) << servo->last().pose.translation.x
      << " " << servo->last().pose.translation.y << " " << servo->last().pose.translation.z;
  EXPECT_EQ(servo->last().isTorqueFelt, !device->info().isTurningUnfelt());
  if (GetParam().maker == Maker::Haply && GetParam().sensedAxes == 3) return;  // Its buttons are its grip's.
  bench.device().buttons = 1;
  EXPECT_TRUE(eventually([&] { return servo->last().isClutched; }));
}

TEST_P(EachMaker, PushesOnceItIsArmedAndNoMoreWhenDisarmed) {
  open();
  servo->send(kPush);
  ASSERT_TRUE(becomes(DeviceState::Ready)) << device->stateNote();
  const std::uint64_t before = bench.device().exchanges;
  ASSERT_TRUE(eventually([&] { return bench.device().exchanges > before + 20; }));
  EXPECT_EQ(vectorOf(bench.device().force.get()), glm::dvec3(0.0)) << "not armed";
  device->arm();
  const glm::dvec3 torque = GetParam().forceAxes == 6 ? kPush.torque : glm::dvec3(0.0);
  EXPECT_TRUE(eventually([&] {
    return isNear(vectorOf(bench.device().force.get()), kPush.force, 1e-9) &&
           isNear(vectorOf(bench.device().torque.get()), torque, 1e-9);
  })) << device->stateNote();
  // There is nothing to reset: it once turned the forces off, and left the device armed.
  device->reset();
  EXPECT_EQ(device->state(), DeviceState::Armed);
  const std::uint64_t then = bench.device().exchanges;
  ASSERT_TRUE(eventually([&] { return bench.device().exchanges > then + 20; }));
  EXPECT_TRUE(eventually([&] { return isNear(vectorOf(bench.device().force.get()), kPush.force, 1e-9); }));
  device->disarm();
  EXPECT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()) == glm::dvec3(0.0); }));
  EXPECT_EQ(device->state(), DeviceState::Ready);
}

TEST_P(EachMaker, LetsGoWhenNearfitFallsSilent) {
  open();
  servo->send(kPush);
  arm();
  ASSERT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()).z < -0.5; }));
  servo->stop();
  EXPECT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()) == glm::dvec3(0.0); }));
}

TEST_P(EachMaker, ClosesWithItsMotorsAtRestAndOpensAgain) {
  for (int i = 0; i < 3; ++i) {
    open();
    servo->send(kPush);
    arm();
    ASSERT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()).z < -0.5; })) << i;
    servo.reset();
    device->stop();
    EXPECT_EQ(device->state(), DeviceState::Present);
    // A service is told last of all, and idles by itself.
    EXPECT_EQ(vectorOf(bench.device().force.get()), glm::dvec3(0.0)) << i;
  }
}

TEST_P(EachMaker, IsLostWhenUnpluggedAndCanBeOpenedOncePluggedInAgain) {
  open();
  servo->send(kPush);
  arm();
  ASSERT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()).z < -0.5; }));
  bench.device().isPlugged = false;
  EXPECT_TRUE(becomes(DeviceState::Lost)) << device->stateNote();
  EXPECT_TRUE(eventually([&] { return servo->hasEnded(); }));
  EXPECT_NE(device->stateNote(), "");
  servo.reset();
  device->stop();
  bench.device().isPlugged = true;
  device->start({});
  servo.emplace(*device);
  EXPECT_TRUE(becomes(DeviceState::Ready)) << device->stateNote();
  EXPECT_FALSE(servo->last().isArmed) << "being plugged in again arms nothing";
}

TEST_P(EachMaker, IsStoppedWhenItsDriverStalls) {
  // A busy machine stops it too, which is as good a stop.
  open(SafetyLimits{});
  arm();
  bench.device().isStalled = true;
  EXPECT_TRUE(becomes(DeviceState::Fault)) << device->stateNote();
  EXPECT_THAT(device->stateNote(), HasSubstr(faultReason(DeviceFault::Silent)));
  bench.device().isStalled = false;
  ASSERT_TRUE(eventually([&] { return servo->last().age < 5e-3; }));
  device->reset();
  EXPECT_TRUE(becomes(DeviceState::Ready)) << device->stateNote();
}

TEST_P(EachMaker, ClosesWhileItStallsAndPushesNoMore) {
  // A service that hangs is waited for so long, and no longer.
  const ScopedVariable patience("NEARFIT_HAPLY_PATIENCE", "2000");
  open();
  servo->send(kPush);
  arm();
  ASSERT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()).z < -0.5; }));
  bench.device().isStalled = true;
  servo->stop();
  std::future<void> closed = std::async(std::launch::async, [this] { device->stop(); });
  const bool hasClosed = closed.wait_for(test::kPatience) == std::future_status::ready;
  EXPECT_TRUE(hasClosed) << "it waits for a driver that hangs";
  bench.device().isStalled = false;
  closed.get();
  EXPECT_TRUE(eventually([&] { return !bench.device().isOpen; })) << "what was left behind ends";
  EXPECT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()) == glm::dvec3(0.0); }));
  // It can be opened again, and has forgotten that it was armed.
  device->start({});
  servo.emplace(*device);
  EXPECT_TRUE(becomes(DeviceState::Ready)) << device->stateNote();
  EXPECT_FALSE(servo->last().isArmed);
}

TEST_P(EachMaker, CannotBeArmedBeforeItsPoseIsKnown) {
  bench.device().isCalibrated = false;
  // An inkwell: OpenHaptics' others calibrate by themselves.
  if (GetParam().maker == Maker::OpenHaptics) bench.device().status = 4;
  open();
  ASSERT_TRUE(becomes(DeviceState::Uncalibrated));
  EXPECT_NE(device->stateNote(), "");
  EXPECT_THROW(device->arm(), DeviceError);
  if (GetParam().maker == Maker::Haply) {
    EXPECT_THROW(device->calibrate(), DeviceError) << "its service calibrates";
    bench.device().isCalibrated = true;
  } else {
    device->calibrate();
  }
  EXPECT_TRUE(becomes(DeviceState::Ready)) << device->stateNote();
}

struct MakerFault {
  int error, status;
  DeviceFault fault;  ///< None: the device is lost.
};
/// So many calls fail in a fault of Force Dimension's: those that go on for long are a loss.
constexpr int kPassingFailures = 5;

std::vector<MakerFault> faultsOf(Maker maker) {
  switch (maker) {
    case Maker::OpenHaptics:
      return {{0x200, 0, DeviceFault::Hot},        {0x201, 0, DeviceFault::Overloaded},
              {0x202, 0, DeviceFault::Overloaded}, {0x203, 0, DeviceFault::TooFast},
              {0x204, 0, DeviceFault::Overloaded}, {0x300, 0, DeviceFault::Reported},
              {0x304, 0, DeviceFault::Reported},   {0x303, 0, DeviceFault::Reported},
              {0x102, 0, DeviceFault::Reported},   {0x600, 0, DeviceFault::Reported},
              {0x302, 0, DeviceFault::None}};
    case Maker::ForceDimension:
      return {
          {7, 0, DeviceFault::BrokenLink},  {3, 0, DeviceFault::BrokenLink}, {1, 0, DeviceFault::Reported},
          {8, 0, DeviceFault::Reported},    {18, 0, DeviceFault::Reported},  {0, 2, DeviceFault::TooFast},
          {0, 3, DeviceFault::BrokenLink},  {0, 5, DeviceFault::BrokenLink}, {0, 1, DeviceFault::SwitchedOff},
          {0, 6, DeviceFault::SwitchedOff}, {2, 0, DeviceFault::None},       {5, 0, DeviceFault::None},
          {12, 0, DeviceFault::None},       {7, 0, DeviceFault::None}};
    case Maker::Haply:
      return {{3, 0, DeviceFault::SwitchedOff},
              {4, 0, DeviceFault::Reported},
              {1, 0, DeviceFault::None},
              {2, 0, DeviceFault::None}};
  }
  return {};
}

TEST_P(EachMaker, EachOfItsErrorsIsAFaultOfOurs) {
  for (const MakerFault& each : faultsOf(GetParam().maker)) {
    bench.device().restart();
    open();
    servo->send(kPush);
    arm();
    ASSERT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()).z < -0.5; }));
    const bool isPassing = GetParam().maker == Maker::ForceDimension && each.fault != DeviceFault::None;
    bench.device().failures = isPassing ? kPassingFailures : -1;
    bench.device().status = each.status;
    bench.device().error = each.error;
    if (each.fault == DeviceFault::None) {
      // A device that a message leaves out falls silent first.
      EXPECT_TRUE(becomes(DeviceState::Lost)) << each.error << device->stateNote();
    } else {
      EXPECT_TRUE(becomes(DeviceState::Fault)) << each.error;
      EXPECT_THAT(device->stateNote(), HasSubstr(faultReason(each.fault)))
          << each.error << " " << each.status;
    }
    bench.device().error = bench.device().status = 0;
    EXPECT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()) == glm::dvec3(0.0); }))
        << each.error;
    TearDown();
  }
}

TEST_P(EachMaker, TwoDevicesAreTwo) {
  bench.standin().count = 2;
  ASSERT_EQ(bench.plugin()->devices().size(), 2U);
  open();
  const std::unique_ptr<HapticDevice> other = bench.make(1);
  other->start({});
  test::MakerServo otherServo(*other);
  servo->send({{0.0, 0.0, 0.5}, {}});
  otherServo.send({{0.5, 0.0, 0.0}, {}});
  arm();
  ASSERT_TRUE(eventually([&] { return other->state() == DeviceState::Ready; })) << other->stateNote();
  other->arm();
  EXPECT_TRUE(eventually([&] {
    return isNear(vectorOf(bench.device(0).force.get()), {0.0, 0.0, 0.5}, 1e-9) &&
           isNear(vectorOf(bench.device(1).force.get()), {0.5, 0.0, 0.0}, 1e-9);
  }));
  otherServo.stop();
  other->stop();
  // Closing one leaves the other as it is, but for a pause.
  EXPECT_TRUE(eventually([&] {
    return isNear(vectorOf(bench.device(0).force.get()), {0.0, 0.0, 0.5}, 1e-9);
  })) << device->stateNote();
  EXPECT_EQ(device->state(), DeviceState::Armed) << device->stateNote();
}

INSTANTIATE_TEST_SUITE_P(All, EachMaker, testing::ValuesIn(test::kMakerModels),
                         [](const auto& each) { return std::string(each.param.name); });

/// Makers whose drivers say all the time that a pose is known; OpenHaptics is asked once.
class MakerThatForgets : public EachMaker {
 protected:
  void turnPower(bool isOn) {
    if (GetParam().maker == Maker::Haply)
      bench.device().error = isOn ? 0 : 3;
    else
      bench.device().status = isOn ? 0 : -1;
  }
  /// What the driver's thread saw last may stop it once more.
  bool becomesByReset(DeviceState state) {
    return eventually([&] {
      device->reset();
      return device->state() == state;
    });
  }
};

TEST_P(MakerThatForgets, IsStoppedIfItForgetsItsPlaceWhileItIsArmed) {
  open();
  servo->send(kPush);
  arm();
  ASSERT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()).z < -0.5; }));
  bench.device().isCalibrated = false;
  EXPECT_TRUE(becomes(DeviceState::Fault));
  EXPECT_THAT(device->stateNote(), HasSubstr(faultReason(DeviceFault::PoseUnknown)));
  EXPECT_TRUE(eventually([&] { return vectorOf(bench.device().force.get()) == glm::dvec3(0.0); }));
  EXPECT_TRUE(becomesByReset(DeviceState::Uncalibrated));
  bench.device().isCalibrated = true;
  EXPECT_TRUE(becomes(DeviceState::Ready)) << device->stateNote();
}

// It once was ready after that, and its pose was anywhere.
TEST_P(MakerThatForgets, IsUncalibratedOncePowerIsBackAndItIsReset) {
  open();
  arm();
  turnPower(false);
  EXPECT_TRUE(becomes(DeviceState::Fault));
  EXPECT_THAT(device->stateNote(), HasSubstr(faultReason(DeviceFault::SwitchedOff)));
  bench.device().isCalibrated = false;
  turnPower(true);
  EXPECT_TRUE(becomesByReset(DeviceState::Uncalibrated)) << device->stateNote();
  EXPECT_THROW(device->arm(), DeviceError);
}

INSTANTIATE_TEST_SUITE_P(All, MakerThatForgets, testing::Values(test::kMakerModels[3], test::kMakerModels[6]),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(ForceDimensionDevice, APoseThatWasAskedForTooEarlyIsNoNewOne) {
  test::MakerBench bench(test::kMakerModels[3]);
  const std::unique_ptr<HapticDevice> device = bench.make(0, SafetyLimits{});
  device->start({});
  const test::MakerServo servo(*device);
  ASSERT_TRUE(eventually([&] { return device->state() == DeviceState::Ready; }));
  device->arm();
  bench.device().status = -2;
  EXPECT_TRUE(eventually([&] { return device->state() == DeviceState::Fault; })) << "the pose stays the same";
  EXPECT_THAT(device->stateNote(), HasSubstr(faultReason(DeviceFault::Silent)));
}

TEST(ForceDimensionDevice, ALimitThatIsSetInItLowersItsForceOnly) {
  test::MakerBench bench(test::kMakerModels[3]);
  const std::unique_ptr<HapticDevice> device = bench.make();
  for (const auto& [set, used] : {std::pair{5.0, 5.0}, std::pair{-1.0, 12.0}, std::pair{50.0, 12.0}}) {
    bench.device().maxForce = set;
    device->start({});
    EXPECT_DOUBLE_EQ(device->info().limits.maxForce, used) << set;
    device->stop();
  }
}

TEST(OpenHapticsDevice, ItsDriversSpeedLimitLowersOursOnly) {
  test::MakerBench bench(test::kMakerModels[0]);
  const std::unique_ptr<HapticDevice> device = bench.make(0, SafetyLimits{});
  for (const auto& [set, used] : {std::pair{1.5, 1.5}, std::pair{0.0, 3.0}, std::pair{50.0, 3.0}}) {
    bench.device().maxSpeed = set;
    device->start({});
    EXPECT_DOUBLE_EQ(device->info().maxSpeed, used) << set;
    device->stop();
  }
}

TEST(ForceDimensionDevice, ItsGripIsHowFarItsGripperIsOpen) {
  test::MakerBench bench(test::kMakerModels[4]);
  const std::unique_ptr<HapticDevice> device = bench.make();
  device->start({});
  const test::MakerServo servo(*device);
  for (const double grip : {0.0, 0.25, 0.5}) {
    bench.device().grip = grip;
    EXPECT_TRUE(eventually([&] { return servo.last().grip == grip; })) << grip;
  }
}

TEST(ForceDimensionDevice, WithoutAGripperHasNoGrip) {
  test::MakerBench bench(test::kMakerModels[3]);
  const std::unique_ptr<HapticDevice> device = bench.make();
  device->start({});
  const test::MakerServo servo(*device);
  const glm::dvec3 wanted{0.02, 0.0, 0.0};
  bench.device().target.set({wanted.x, wanted.y, wanted.z});
  ASSERT_TRUE(eventually([&] { return isNear(servo.last().pose.translation, wanted, 2.0 * kPlaceSlack); }));
  EXPECT_FALSE(servo.last().grip);
}

TEST(OpenHapticsDevice, ThatIsNotScheduledDoesNotOpen) {
  test::MakerBench bench(test::kMakerModels[0]);
  const std::unique_ptr<HapticDevice> device = bench.make();
  for (const int error : {0x501, 0x304}) {
    bench.device().error = error;
    EXPECT_THROW(device->start({}), DeviceError) << error;
    EXPECT_EQ(device->state(), DeviceState::Present);
    EXPECT_FALSE(bench.device().isOpen);
    bench.device().error = 0;
    EXPECT_NO_THROW(device->start({})) << error;
    device->stop();
  }
}

TEST(HaplyService, ThatEndsLosesItsDevices) {
  test::MakerBench bench(test::kMakerModels[6]);
  const std::unique_ptr<HapticDevice> device = bench.make();
  device->start({});
  test::MakerServo servo(*device);
  bench.service().end();
  EXPECT_TRUE(eventually([&] { return device->state() == DeviceState::Lost; }));
  EXPECT_THAT(device->stateNote(), HasSubstr("Haply Inverse Service"));
  try {
    bench.plugin()->devices();
    FAIL() << "nobody listens";
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.cause(), DeviceProblem::NoDriver);
    EXPECT_THAT(error.remedy(), HasSubstr("Haply Hub"));
  }
}

}  // namespace
}  // namespace nearfit::maker_plugin_test
