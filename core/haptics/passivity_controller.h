#pragma once

#include <glm/vec3.hpp>

#include "core/haptics/device_limits.h"
#include "core/haptics/wrench.h"

namespace nearfit {

/// Wrench and motion between two ticks. All vectors are in one frame that does not rotate; torque is about
/// the point whose motion is `shift` (the part's centre of mass, as the handle carries it).
struct HandInterval {
  Wrench held;             ///< On the handle, as sent at the interval's start.
  glm::dvec3 shift{0.0};   ///< Translation of the handle [m].
  glm::dvec3 turn{0.0};    ///< Rotation of the handle: axis times angle [rad].
  double duration = 0.0;   ///< [s]
  glm::dvec3 weight{0.0};  ///< Weight of the part, as it is felt [N].
  /// Translation of the part's centre [m]. As it sinks, gravity pays for what the hand gets.
  glm::dvec3 partShift{0.0};
};

/// Accounts for the energy that goes to the hand, and takes back, by damping, what exceeds the energy put in
/// by hand and gravity. A wrench is held while the hand moves, so its work over an interval is exactly
/// held . motion, whatever happened in between; energy that a sampled spring creates is included.
///
/// The account is credited with the energy that the hand gives and that gravity gives the part, and debited
/// with what the hand gets. The device's own damping dissipates at least b |motion|^2 / duration and is
/// credited too, so a wall within Colgate's bound is never touched. The balance may keep no more than
/// coupling and part store at that moment: energy lost in friction, damping or free motion gives no right to
/// vibrate later. A negative balance is a debt.
///
/// Crediting all of the device's damping would let a wall beyond the bound vibrate on: none would be left to
/// calm it. So after a debt, which no wall within the bound causes, only kDoubtfulShare of it is credited;
/// the full share returns within kDoubtTime.
///
/// A debt is paid by damping that would remove it in one tick at the hand's velocity: first along the force
/// (energy enters through force times velocity, and sliding is to stay free), the rest across it. The damping
/// is at most leastMass / (2 period): more would reverse a light hand within a tick. Debt beyond kMaxDebt is
/// forgotten: the hand has spent it.
///
/// Real-time safe throughout. Source: Hannaford & Ryu 2002, Time-domain passivity control of haptic
/// interfaces; the work of a held force as in Stramigioli et al. 2005, Sampled data systems passivity and
/// discrete port-Hamiltonian systems. Deviations: the limit on the balance, the device's damping in the
/// account, the direction of the damping.
class PassivityController {
 public:
  /// Max debt [J]: enough to move a hand of 100 g at 1 m/s.
  static constexpr double kMaxDebt = 0.05;
  /// The balance may exceed the stored energy by this [J]. Rendered damping pays half a tick late, and that
  /// delay (some B v^2 T, for 0.2 N s/m at 0.2 m/s) is no fault. It moves a hand of 200 g at 1 cm/s.
  static constexpr double kSlack = 1e-5;

  /// Share of the device's damping that is credited right after a debt.
  static constexpr double kDoubtfulShare = 0.5;
  static constexpr double kDoubtTime = 0.5;  ///< Time until all of it is credited again [s].

  /// Starts a new account.
  void reset() noexcept { *this = PassivityController{}; }

  /// Accounts for an interval. Ignores it if any number is not finite. Without a duration, the device's
  /// damping is not credited.
  /// @param limits  Limits at the handle (limitsAtHandle()).
  /// @param stored  Upper bound on the energy that can return to the hand after the interval, before the part
  ///                moves on [J]: storedEnergy() plus kineticEnergy(), or kMaxDebt if unknown.
  void observe(const HandInterval& interval, const DeviceLimits& limits, double stored) noexcept;

  /// Damping to add to the wrench of the next tick, before that is clamped. Zero without debt or if the hand
  /// does not move; within the device's max force and torque.
  /// @param limits  Limits at the handle (limitsAtHandle()).
  /// @param period  How long the damping will be held [s]; it is zero unless this is finite and > 0.
  Wrench damping(const DeviceLimits& limits, double period) const noexcept;

  /// Net work done on the hand since the reset [J]; positive if the hand got more than it gave.
  /// Includes weight.
  double energyToHand() const noexcept { return energyToHand_; }
  /// Energy still to be taken back [J]; >= 0.
  double debt() const noexcept { return balance_ < 0.0 ? -balance_ : 0.0; }

 private:
  double energyToHand_ = 0.0;
  double balance_ = kSlack;
  double doubt_ = 0.0;                           ///< 1 at a debt, then falling to 0.
  Twist velocity_;                               ///< Mean over the last interval.
  glm::dvec3 forceAxis_{0.0}, torqueAxis_{0.0};  ///< Unit; zero until the first force.
};

}  // namespace nearfit
