#include "tests/makers/maker_contact.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include "device/servo/servo_loop.h"
#include "tests/support/eventually.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::test {
namespace {

using SteadyClock = std::chrono::steady_clock;

std::unique_ptr<ServoScene> pegOverFloor() {
  static const PartGeometryPtr peg = geometryOf(boxMesh({0.04, 0.04, 0.1}));
  static const PartGeometryPtr floor = geometryOf(boxMesh({2.0, 2.0, 1.0}, {0.0, 0.0, -0.5}));
  auto scene = std::make_unique<ServoScene>();
  scene->setMoving({PartId{2}, peg, {glm::dquat(1.0, 0.0, 0.0, 0.0), {0.0, 0.0, 0.05 + kContactGap}}});
  scene->bodies.push_back({PartId{1}, floor, {}});
  return scene;
}

/// Looks in a row that must find the handle at rest.
constexpr int kRestLooks = 50;
constexpr double kRestSpeed = 2e-3;  // [m/s]
/// Its friction holds the handle a little off where the forces would balance [N].
constexpr double kBalanceSlack = 1.2 * StandinDevice::kFriction;
constexpr double kFeltForce = 0.5;  // [N]

class Pressing {
 public:
  Pressing(MakerBench& bench, const SafetyLimits& safety)
      : hand_(bench.device()), device_(bench.make(0, safety)) {}

  ContactOutcome run(double seconds) {
    loop_.start(*device_, pegOverFloor(), ServoParameters{});
    out_.wasReady = eventually([&] { return device_->state() == DeviceState::Ready; });
    if (out_.wasReady) {
      device_->arm();
      press(seconds);
      hand_.target.set({});
      out_.wasLetGo = eventually([&] {
        look();
        return std::abs(hand_.position.get()[2]) < 2e-3 && std::abs(hand_.force.get()[2]) < 0.05;
      });
    }
    out_.maxEnergyGiven = hand_.maxEnergyGiven;
    out_.note = device_->stateNote();
    loop_.stop();
    out_.roundTrip = loop_.statistics().roundTrip;
    return out_;
  }

 private:
  void press(double seconds) {
    lowerTo(-kContactTarget);
    out_.wasFelt = eventually([&] {
      look();
      return hand_.force.get()[2] > kFeltForce;
    });
    slide(seconds);
    int atRest = 0;
    // Motors pause while a busy machine does not answer, so the handle may have to come to rest more than once.
    out_.cameToRest = eventually([&] {
      look();
      out_.force = hand_.force.get()[2];
      out_.handPull = kContactHand * (hand_.position.get()[2] + kContactTarget);
      const bool isBalanced =
          out_.force > kFeltForce && std::abs(out_.force - out_.handPull) <= kBalanceSlack;
      atRest = hand_.speed < kRestSpeed && isBalanced ? atRest + 1 : 0;
      return atRest >= kRestLooks;
    });
  }
  /// A tenth of a millimetre each millisecond, or slower.
  void lowerTo(double z) {
    for (double at = 0.0; at > z; at -= 1e-4) {
      hand_.target.set({0.0, 0.0, at});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      look();
    }
    hand_.target.set({0.0, 0.0, z});
  }
  /// To and fro by a centimetre each second.
  void slide(double seconds) {
    const SteadyClock::time_point begin = SteadyClock::now();
    for (;;) {
      const double time = std::chrono::duration<double>(SteadyClock::now() - begin).count();
      if (time >= seconds) break;
      hand_.target.set({0.005 * std::sin(2.0 * std::numbers::pi * time), 0.0, -kContactTarget});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      look();
    }
    hand_.target.set({0.0, 0.0, -kContactTarget});
  }
  void look() { out_.deepest = std::min(out_.deepest, hand_.position.get()[2]); }

  StandinDevice& hand_;
  std::unique_ptr<HapticDevice> device_;
  ServoLoop loop_;
  ContactOutcome out_;
};

}  // namespace

ContactOutcome pressOnFloor(MakerBench& bench, double seconds, const SafetyLimits& safety) {
  return Pressing(bench, safety).run(seconds);
}

}  // namespace nearfit::test
