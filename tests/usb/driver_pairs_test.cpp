#include <array>
#include <thread>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/usb/driver_bench.h"
#include "tests/usb/pace.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::driver_pairs_test {
namespace {

using test::eventually;

/// Two devices on a bus, each with a driver and a servo of its own.
class TwoDevices : public testing::TestWithParam<std::tuple<test::DriverKind, test::DriverKind>> {
 protected:
  void SetUp() override {
    bench = {std::get<0>(GetParam()).make(), std::get<1>(GetParam()).make()};
    for (unsigned i = 0; i < 2; ++i)
      bus.plug(bench.at(i)->emulated(), i + 1);
    const std::vector<UsbDescription> seen = UsbBus().list();
    ASSERT_EQ(seen.size(), 2U);
    for (const UsbDescription& each : seen) {
      const std::size_t i = each.ports.back() - 1U;
      device.at(i) = bench.at(i)->make(each, test::lenientSafety());
    }
    for (std::size_t i = 0; i < 2; ++i)
      bringUp(i);
  }
  void bringUp(std::size_t i) {
    bench.at(i)->start(*device.at(i));
    bench.at(i)->makeWell(*device.at(i));
    next.at(i) = 0;
    if (bench.at(i)->traits().pushes) device.at(i)->arm();
    ASSERT_EQ(device.at(i)->state(), DeviceState::Armed);
  }
  /// Rounds in which the handle goes on from place to place; on any thread.
  void play(std::size_t i, int count) {
    // At its rate: a place a round, as fast as it goes, would be a runaway that the driver brakes.
    test::Pace pace(bench.at(i)->traits().rate);
    for (const int end = next.at(i) + count; next.at(i) < end; ++next.at(i)) {
      pace.wait();
      const int place = next.at(i);
      bench.at(i)->hold(place);
      ASSERT_TRUE(bench.at(i)->round(*device.at(i), push.at(i), handle.at(i))) << place;
      bench.at(i)->expectHeld(*device.at(i), handle.at(i), place);
    }
  }

  const std::array<Wrench, 2> push{Wrench{{0.5, 0.0, 1.0}, {}}, Wrench{{-0.5, 1.0, 0.0}, {}}};
  test::EmulatedBus bus;
  std::array<std::unique_ptr<test::DriverBench>, 2> bench;
  std::array<std::unique_ptr<HapticDevice>, 2> device;
  std::array<HandleInput, 2> handle;
  std::array<int, 2> next{};  ///< Place.
};

TEST_P(TwoDevices, StreamAtOnceAndEachFeelsItsOwn) {
  constexpr int kCount = 500;
  std::array<std::uint64_t, 2> poses{}, commands{};
  for (std::size_t i = 0; i < 2; ++i) {
    poses.at(i) = device.at(i)->counters().poses;
    commands.at(i) = bench.at(i)->commands();
  }
  {
    std::thread other([&] { play(1, kCount); });
    play(0, kCount);
    other.join();
  }
  for (std::size_t i = 0; i < 2; ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(device.at(i)->counters().poses, poses.at(i) + kCount);
    EXPECT_EQ(device.at(i)->counters().rejected, 0U);
    if (!bench.at(i)->traits().pushes) continue;
    EXPECT_EQ(bench.at(i)->commands(), commands.at(i) + kCount);
    // What is told answers the pose before: once more from the same place.
    ASSERT_TRUE(bench.at(i)->round(*device.at(i), push.at(i), handle.at(i)));
    bench.at(i)->expectTold(push.at(i), handle.at(i));
  }
}

TEST_P(TwoDevices, OneThatIsPulledOutLeavesTheOther) {
  for (const test::Unplugging how :
       {test::Unplugging::NoDevice, test::Unplugging::Protocol, test::Unplugging::Shutdown}) {
    std::thread other([&] { play(1, 200); });
    bus.unplug(*bench[0]->emulated(), how);
    EXPECT_TRUE(eventually([&] { return device[0]->state() == DeviceState::Lost; }));
    other.join();
    EXPECT_EQ(device[1]->state(), DeviceState::Armed) << device[1]->stateNote();
    bench[0]->powerOff();
    device[0]->stop();
    play(1, 20);
    // Plugged in again beside it.
    bus.plug(bench[0]->emulated(), 1);
    for (const UsbDescription& each : UsbBus().list()) {
      if (each.ports.back() == 1) device[0] = bench[0]->make(each, test::lenientSafety());
    }
    bringUp(0);
    play(0, 20);
    play(1, 20);
  }
}

using test::DriverKind;
INSTANTIATE_TEST_SUITE_P(
    Pairs, TwoDevices,
    testing::Values(
        std::tuple{DriverKind{"OpenHap", &test::openHapBench},
                   DriverKind{"SpaceMouse", &test::spaceMouseBench}},
        std::tuple{DriverKind{"Polhem", &test::polhemBench}, DriverKind{"Falcon", &test::falconBench}},
        std::tuple{DriverKind{"Falcon", &test::falconBench}, DriverKind{"OpenHap", &test::openHapBench}},
        std::tuple{DriverKind{"SpaceMouse", &test::spaceMouseBench},
                   DriverKind{"Polhem", &test::polhemBench}},
        // Two of a kind.
        std::tuple{DriverKind{"OpenHap", &test::openHapBench}, DriverKind{"OpenHap", &test::openHapBench}}),
    [](const auto& instance) {
      return std::string(std::get<0>(instance.param).name) + "And" + std::get<1>(instance.param).name;
    });

}  // namespace
}  // namespace nearfit::driver_pairs_test
