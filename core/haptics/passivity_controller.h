#pragma once

#include <glm/vec3.hpp>

#include "core/haptics/device_limits.h"
#include "core/haptics/wrench.h"

namespace nearfit {

/// What passed between two ticks. All in one frame that does not turn; torque about the point whose motion
/// `shift` is (the part's centre of mass, as the handle carries it).
struct HandInterval {
  Wrench held;                ///< As sent at the interval's start, on the handle.
  glm::dvec3 shift{0.0};      ///< Of the handle [m].
  glm::dvec3 turn{0.0};       ///< Of the handle: axis times angle [rad].
  double duration = 0.0;      ///< [s]
  glm::dvec3 weight{0.0};     ///< Of the part, where it is felt [N].
  glm::dvec3 partShift{0.0};  ///< Of the part's centre [m]: as it sinks, gravity pays for what the hand gets.
};

/// Keeps account of the energy that goes to the hand, and takes back, by damping, what is more than hand and
/// gravity have put in. Since a wrench is held while the hand moves, its work over an interval is exactly
/// held . motion, whatever happened in between; what a sampled spring makes of nothing is in it.
///
/// The account: what the hand gives and what gravity gives the part go in, what the hand gets comes out. The
/// device's own damping dissipates at least b |motion|^2 / duration and goes in too: so a wall within
/// Colgate's bound is never touched. What the balance may keep is no more than coupling and part store at
/// that moment, since what was lost in friction, damping or free motion is no right to vibrate later. Below
/// zero it is a debt.
///
/// All of the device's damping in the account would let a wall beyond the bound just vibrate on: none would
/// be left to calm it. So after a debt, which no wall within the bound makes, only kDoubtfulShare of it
/// counts, and comes back within kDoubtTime.
///
/// A debt is paid by damping that would take it out in one tick at the hand's velocity, first along the
/// force (energy comes in through force times velocity, and sliding is to stay free), what is left against
/// all of the motion. The damping is at most leastMass / (2 period): more would turn a light hand round
/// within a tick. Debt beyond kMostDebt is forgotten: the hand has spent it.
///
/// Real-time safe throughout. Source: Hannaford & Ryu 2002, Time-domain passivity control of haptic
/// interfaces; the work of a held force as in Stramigioli et al. 2005, Sampled data systems passivity and
/// discrete port-Hamiltonian systems. Deviations: what the balance may keep, the device's damping in the
/// account, the direction of the damping.
class PassivityController {
 public:
  /// Moves a hand of 100 g at 1 m/s [J].
  static constexpr double kMostDebt = 0.05;
  /// The balance may keep this beyond what is stored [J]: rendered damping pays half a tick late, and what
  /// that is (some B v^2 T, for 0.2 N s/m at 0.2 m/s) is no fault. Moves a hand of 200 g at 1 cm/s.
  static constexpr double kSlack = 1e-5;

  static constexpr double kDoubtfulShare = 0.5;
  static constexpr double kDoubtTime = 0.5;  ///< [s]

  void reset() noexcept { *this = PassivityController{}; }

  /// @param limits  Of the device, as at the handle (limitsAtHandle).
  /// @param stored  What can come back to the hand at the interval's end, before the part moves on [J]:
  ///                storedEnergy plus kineticEnergy, or a bound of it; kMostDebt where it is not known.
  /// An interval with numbers that are not finite is left out. Without a duration, damping has no share.
  void observe(const HandInterval& interval, const DeviceLimits& limits, double stored) noexcept;

  /// To be added to the wrench for the next tick, before it is clamped; zero without debt, or for a hand that
  /// does not move. Within the device's force and torque.
  /// @param period  How long it will be held [s]; zero wrench unless > 0 and finite.
  Wrench damping(const DeviceLimits& limits, double period) const noexcept;

  /// Work done on the hand since the reset, less what came back [J]: positive when the hand has got more than
  /// it gave (weight included).
  double energyToHand() const noexcept { return energyToHand_; }
  /// What is still to be taken back [J]; >= 0.
  double debt() const noexcept { return balance_ < 0.0 ? -balance_ : 0.0; }

 private:
  double energyToHand_ = 0.0;
  double balance_ = kSlack;
  double doubt_ = 0.0;                           ///< 1 at a debt, falling to 0.
  Twist velocity_;                               ///< Mean of the last interval.
  glm::dvec3 forceAxis_{0.0}, torqueAxis_{0.0};  ///< Unit, or zero as long as there was none.
};

}  // namespace nearfit
