#include "tests/usb/driver_fixture.h"

namespace nearfit::test {

void DriverRig::use(const DriverKind& kind) {
  bench = kind.make();
  bus.plug(bench->emulated());
  make();
}

void DriverRig::make(const SafetyLimits& safety) {
  const std::vector<UsbDescription> seen = UsbBus().list();
  ASSERT_EQ(seen.size(), 1U) << "it is not seen on the bus";
  device = bench->make(seen[0], safety);
}

void DriverRig::bringUp() {
  bench->start(*device);
  bench->makeWell(*device);
  if (!pushes()) return;
  ASSERT_EQ(device->state(), DeviceState::Ready) << device->stateNote();
  device->arm();
}

void DriverRig::streamAndFeel() {
  bench->stream();
  const std::uint64_t before = device->counters().poses;
  servo = std::make_unique<SteadyServo>(*device, push);
  ASSERT_TRUE(eventually([&] { return device->counters().poses >= before + 20; }));
  if (pushes()) {
    ASSERT_TRUE(eventually([&] { return bench->isPushing(); })) << device->stateNote();
  }
}

DeviceError DriverRig::errorOfStart() {
  try {
    device->start({});
  } catch (const DeviceError& error) {
    return error;
  }
  ADD_FAILURE() << "it was opened";
  return {DeviceProblem::Failed, "", ""};
}

void DriverRig::expectClosed(DeviceState state) {
  EXPECT_EQ(device->state(), state);
  EXPECT_FALSE(emulated().isOpen());
  EXPECT_EQ(emulated().outstanding(), 0U);
  EXPECT_EQ(emulated().leftAtClose(), 0U);
}

}  // namespace nearfit::test
