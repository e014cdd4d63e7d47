#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/usb/driver_fixture.h"

namespace nearfit::driver_loss_test {
namespace {

using test::eventually;
using test::Unplugging;
using testing::HasSubstr;

struct Way {
  const char* name;
  Unplugging how;
};
std::ostream& operator<<(std::ostream& to, const Way& way) {
  return to << way.name;
}

class DriverUnplugged : public test::DriverRig,
                        public testing::WithParamInterface<std::tuple<test::DriverKind, Way>> {
 protected:
  void SetUp() override { use(std::get<0>(GetParam())); }
};

TEST_P(DriverUnplugged, InMidStreamIsLostAndNotArmedByBeingPluggedInAgain) {
  bringUp();
  streamAndFeel();
  bus.unplug(emulated(), std::get<1>(GetParam()).how);
  EXPECT_TRUE(eventually([&] { return servo->hasEnded(); })) << "the servo is told";
  EXPECT_EQ(device->state(), DeviceState::Lost);
  EXPECT_FALSE(device->stateNote().empty());
  EXPECT_FALSE(device->readHandle(handle));
  device->sendWrench(push);
  if (pushes()) {
    EXPECT_THROW(device->arm(), DeviceError);
  }
  servo.reset();
  bench->powerOff();
  device->stop();
  expectClosed(DeviceState::Lost);
  EXPECT_THROW(device->start({}), DeviceError) << "plugged in again it is another";

  bus.plug(bench->emulated());
  make();
  bench->start(*device);
  EXPECT_EQ(device->state(), bench->traits().opened);
  bench->makeWell(*device);
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(bench->round(*device, push, handle));
  EXPECT_FALSE(bench->isPushing());
  if (pushes()) {
    EXPECT_EQ(device->state(), DeviceState::Ready);
    device->arm();
  }
  streamAndFeel();
}

INSTANTIATE_TEST_SUITE_P(All, DriverUnplugged,
                         testing::Combine(testing::ValuesIn(test::kDriverKinds),
                                          testing::Values(Way{"NoDevice", Unplugging::NoDevice},
                                                          Way{"Protocol", Unplugging::Protocol},
                                                          Way{"Shutdown", Unplugging::Shutdown},
                                                          Way{"Cancelled", Unplugging::Cancelled})),
                         [](const auto& instance) {
                           return std::string(std::get<0>(instance.param).name) + "Ends" +
                                  std::get<1>(instance.param).name;
                         });

class DriverLoses : public test::EachDriver {};

TEST_P(DriverLoses, ADeviceWhoseReportsStallForGood) {
  bringUp();
  streamAndFeel();
  emulated().stall(bench->traits().in, true);
  EXPECT_TRUE(eventually([&] { return servo->hasEnded(); }));
  EXPECT_EQ(device->state(), DeviceState::Lost);
  EXPECT_THAT(device->stateNote(), HasSubstr("stalls"));
  servo.reset();
  bench->stopStreaming();
  device->stop();
  expectClosed(DeviceState::Lost);
}

TEST_P(DriverLoses, ADeviceWhoseCommandsStallForGood) {
  if (!pushes()) return;  // It takes no commands.
  bringUp();
  streamAndFeel();
  emulated().stall(bench->traits().out, true);
  EXPECT_TRUE(eventually([&] { return servo->hasEnded(); })) << "reports do not excuse it";
  EXPECT_EQ(device->state(), DeviceState::Lost);
  EXPECT_THAT(device->stateNote(), HasSubstr("stalls"));
}

TEST_P(DriverLoses, NoDeviceButStopsOneThatAnswersNoMore) {
  if (!pushes()) return;  // A space mouse is silent while it rests: spacemouse_usb_test.cpp.
  // Long enough to see it push on any machine; should it not be, it is stopped for the same reason.
  constexpr double kSilence = 0.3;
  make(test::safetyWith(kSilence));
  bringUp();
  bench->stream();
  servo = std::make_unique<test::SteadyServo>(*device, push);
  bench->stopStreaming();
  emulated().hang(true);
  ASSERT_TRUE(eventually([&] { return device->state() == DeviceState::Fault; }));
  EXPECT_EQ(device->stateNote(), faultReason(DeviceFault::Silent));
  EXPECT_FALSE(servo->hasEnded()) << "it is there";
  EXPECT_FALSE(servo->stop().isArmed);
  EXPECT_THROW(device->arm(), DeviceError);
  device->stop();
  expectClosed(DeviceState::Present);

  // It answers again: opened anew it works, and nobody has armed it.
  emulated().hang(false);
  bench->powerOff();
  bench->start(*device);
  bench->makeWell(*device);
  ASSERT_TRUE(bench->round(*device, push, handle));
  EXPECT_EQ(device->state(), DeviceState::Ready);
  EXPECT_FALSE(bench->isPushing());
}

INSTANTIATE_TEST_SUITE_P(All, DriverLoses, testing::ValuesIn(test::kDriverKinds), test::nameOf);

}  // namespace
}  // namespace nearfit::driver_loss_test
