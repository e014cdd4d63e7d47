#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <string>

/// What stands in for a maker's driver in tests: libraries with the same symbols, and a service. Behind each are devices
/// of this kind, which a simulated hand holds. Everything is in Nearfit's frame: x to the right, y away, z up.
namespace nearfit::test {

using Triple = std::array<double, 3>;

/// A value of three numbers that one thread writes and others read.
class SharedTriple {
 public:
  Triple get() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }
  void set(const Triple& value) {
    const std::lock_guard lock(mutex_);
    value_ = value;
  }

 private:
  mutable std::mutex mutex_;
  Triple value_{};
};

/// A device: a mass with friction and damping, held by a hand that is a spring and a damper to a target. Forces act a
/// sample late, as behind a link.
class StandinDevice {
 public:
  // Set by tests at any time.
  SharedTriple target;                   ///< Where the hand wants the handle [m].
  std::atomic<double> turn{0.0};         ///< Orientation: about y [rad].
  std::atomic<bool> isPlugged{true};     ///< False: as if it were pulled out.
  std::atomic<bool> isStalled{false};    ///< Its driver's thread, or its answers, stand still.
  std::atomic<int> error{0};             ///< The maker's code that each exchange fails with; 0 for none.
  std::atomic<int> failures{-1};         ///< So many more calls fail with `error`; less than 0: all.
  std::atomic<int> status{0};            ///< What a maker's status has besides errors; see each stand-in.
  std::atomic<bool> isCalibrated{true};  ///< Its pose is known; its maker's call calibrates it.
  std::atomic<int> buttons{0};
  std::atomic<double> maxForce{-1.0};       ///< Limit that is set in it, of an omega [N]; negative: none.
  std::atomic<double> maxSpeed{0.0};        ///< Above it a Touch's driver turns forces off [m/s]; 0: unknown.
  std::atomic<double> sinking{sinkRate()};  ///< The hand's target sinks so fast, in the device's time [m/s].
  std::atomic<double> grip{kRestingGrip};   ///< Opening of its gripper, if its model has one [rad].

  // Seen by tests.
  SharedTriple position, force, torque;  ///< [m]; as its motors were told last [N], [N m].
  std::atomic<double> speed{0.0};        ///< [m/s]
  /// What the hand has got from the device [J]: work of the motors, less what friction and damping took and what the
  /// handle moves with. Negative: the hand gave it.
  std::atomic<double> energyGiven{0.0};
  std::atomic<double> maxEnergyGiven{0.0};  ///< The most that it ever was.
  std::atomic<std::uint64_t> exchanges{0};
  std::atomic<bool> isOpen{false};

  /// Driver's thread: true if a call is to fail with `error`; counts it.
  bool failsNow() {
    if (error == 0 || failures == 0) return false;
    if (failures > 0) --failures;
    return true;
  }
  /// What the motors are told from now on.
  void push(const Triple& newForce, const Triple& newTorque) {
    force.set(newForce);
    torque.set(newTorque);
    for (const Triple& each : {newForce, newTorque})
      for (const double part : each)
        if (!std::isfinite(part)) std::abort();
  }
  /// Moves on by `seconds`, with the force of the exchange before: the link is a sample late.
  void advance(double seconds) {
    const Triple next = force.get();
    sunk_ += sinking * std::min(seconds, kMaxTime);
    Triple wanted = target.get();
    wanted[2] -= sunk_;
    const int steps = std::max(1, static_cast<int>(std::ceil(std::min(seconds, kMaxTime) / kStep)));
    const double dt = std::min(seconds, kMaxTime) / steps;
    for (int i = 0; i < steps; ++i)
      step(dt, wanted);
    acting_ = next;
    position.set(at_);
    velocity.set(velocity_);
    speed.store(std::hypot(velocity_[0], velocity_[1], velocity_[2]));
    exchanges.fetch_add(1);
  }
  SharedTriple velocity;  ///< [m/s]

  /// Back to what it was when it was made; while nothing runs.
  void restart() {
    target.set({});
    turn = 0.0;
    grip = kRestingGrip;
    maxForce = -1.0;
    maxSpeed = 0.0;
    sinking = sunk_ = 0.0;
    isPlugged = isCalibrated = true;
    isStalled = isOpen = false;
    error = status = buttons = 0;
    failures = -1;
    for (SharedTriple* each : {&position, &velocity, &force, &torque})
      each->set({});
    speed = energyGiven = maxEnergyGiven = 0.0;
    at_ = velocity_ = acting_ = {};
    net_ = 0.0;
  }

  static constexpr double kRestingGrip = 0.375;  ///< [rad]
  /// A Touch: its apparent mass, and friction as its maker gives it.
  static constexpr double kMass = 0.045, kFriction = 0.3;  // [kg], [N]

 private:
  static constexpr double kStep = 1e-4;    ///< Of the mechanics [s].
  static constexpr double kMaxTime = 0.1;  ///< After a stall, the handle does not jump [s].
  /// A relaxed hand (Kuchenbecker 2003 and others measured some hundred N/m and some N s/m), and its mass.
  static constexpr double kHandStiffness = 300.0, kHandDamping = 5.0, kHandMass = 0.1;
  static constexpr double kDamping = 0.2;  ///< Of the device itself [N s/m].

  void step(double dt, const Triple& wanted) {
    const double mass = kMass + kHandMass;
    double friction = std::hypot(velocity_[0], velocity_[1], velocity_[2]);
    // Smooth at rest: Coulomb's law has a step there.
    friction = kFriction / std::max(friction, 1e-3);
    double speedSquared = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      // Damping and friction implicit, so that no step overshoots.
      const double resist = kHandDamping + kDamping + friction;
      const double pull = kHandStiffness * (wanted[i] - at_[i]) + acting_[i];
      velocity_[i] = (mass * velocity_[i] + dt * pull) / (mass + dt * resist);
      at_[i] += dt * velocity_[i];
      net_ += dt * velocity_[i] * (acting_[i] - (kDamping + friction) * velocity_[i]);
      speedSquared += velocity_[i] * velocity_[i];
    }
    energyGiven.store(net_ - 0.5 * kMass * speedSquared);
    maxEnergyGiven.store(std::max(maxEnergyGiven.load(), energyGiven.load()));
  }

  /// Of a program that a test runs, by NEARFIT_STANDIN_SINKING.
  static double sinkRate() {
    const char* const text = std::getenv("NEARFIT_STANDIN_SINKING");
    return text != nullptr ? std::atof(text) : 0.0;
  }

  Triple at_{}, velocity_{}, acting_{};
  double sunk_ = 0.0;  ///< [m]
  double net_ = 0.0;   ///< Work of the motors less what the device took [J].
};

/// The devices of a stand-in.
struct Standin {
  std::array<StandinDevice, 2> devices;
  /// Number that is there; another program sets it by NEARFIT_STANDIN_DEVICES.
  std::atomic<int> count{numberIn("NEARFIT_STANDIN_DEVICES", 1)};
  /// The maker's number for the model; NEARFIT_STANDIN_MODEL. See each stand-in.
  std::atomic<int> model{numberIn("NEARFIT_STANDIN_MODEL", 0)};

  void restart() {
    for (StandinDevice& each : devices)
      each.restart();
    count = 1;
    model = 0;
  }

  static int numberIn(const char* variable, int usual) {
    const char* const text = std::getenv(variable);
    return text != nullptr ? std::atoi(text) : usual;
  }
};

}  // namespace nearfit::test

/// Each library that stands in exports this beside its maker's symbols.
extern "C" nearfit::test::Standin* nearfit_standin();
