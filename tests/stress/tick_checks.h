#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/servo/servo_tick.h"

namespace nearfit::stress {

/// The energy that the hand has got, reckoned beside the servo from what it sent: work of the held wrench
/// less what the device's damping takes and gravity pays.
///
/// What is bound: in no stretch of time does the hand gain more than was stored, between it and the part, at
/// the stretch's beginning, but for PassivityController's slack and its largest debt. It holds for a hand
/// that has a mass; one that is led along a path, however strong, is bound by force times way alone.
class EnergyLedger {
 public:
  /// Of one tick.  @param sent  The wrench that was held while the handle moved to where `now` has it.
  void add(const ServoScene& scene, const ServoParameters& parameters, const ServoSnapshot& before,
           const ServoSnapshot& now, double period);
  /// Stretches begin anew: the hand before was another.
  void cut() noexcept { hasLeast_ = false; }

  double energyToHand() const noexcept { return given_; }
  /// The largest gain so far beyond what was stored [J].
  double largestGain() const noexcept { return largestGain_; }

 private:
  double given_ = 0.0, gain_ = 0.0;
  double least_ = 0.0;  ///< Of gain and store, in this stretch.
  bool hasLeast_ = false;
  double largestGain_ = 0.0;
};

/// The servo's account of the energy given to the hand may differ from one kept beside it by so much of what
/// went to and fro: both are sums of millions of small numbers.
constexpr double kMaxLedgerError = 1e-6;

/// The most that a hand may gain [J]: the controller's largest debt and slack, and what a force that the slew
/// limit only lets down from the device's most (10 N at 2000 N/s) gives a hand that goes with it at 2 m/s.
constexpr double kMaxEnergyGain =
    PassivityController::kMaxDebt + PassivityController::kSlack + 0.5 * 10.0 * (10.0 / 2000.0) * 2.0;

/// The same in the modes of springs: the controller takes springs to hold as much as its largest debt, whatever they
/// do, so that a hand may get that back as well.
constexpr double kMaxSpringEnergyGain = kMaxEnergyGain + PassivityController::kMaxDebt;

/// What a tick may be at worst.
struct TickExtremes {
  double quaternionError = 0.0;  ///< Of the part's and the handle's pose, off unit length.
  std::uint64_t work = 0;
  double force = 0.0, torque = 0.0;
  double forceStep = 0.0;       ///< From one tick to the next, before limits and ramps [N].
  double lag = 0.0;             ///< Of the part's centre behind the hand's [m]; zero in the modes of springs.
  std::uint64_t heldTicks = 0;  ///< With springs held back to what the device bears.
  std::uint64_t starved = 0, waiting = 0, shortened = 0, refused = 0, inContact = 0;

  void add(const ServoSnapshot& s);
  /// What needs the tick before, too.
  void addStep(const ServoScene& scene, const ServoSnapshot& before, const ServoSnapshot& now);
};

/// How far a quaternion may be off unit length.
constexpr double kQuaternionError = 1e-12;

/// What is wrong with a tick by itself: a part that overlaps another one (proxy mode) or is not where the hand is (springs), a fault, a number that is none, a length off, a limit passed, work
/// beyond mostWork(). None where all is well.
std::optional<std::string> faultOf(const ServoSnapshot& now, const ServoSnapshot& before,
                                   const ServoParameters& parameters, double period);

}  // namespace nearfit::stress
