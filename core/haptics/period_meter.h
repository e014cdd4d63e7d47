#pragma once

namespace nearfit {

/// The servo's period as the bound of stability needs it: what nearly all ticks keep (their 99th
/// percentile), from the time that really passed between them.
///
/// It follows the percentile by small steps, up by kRise where a tick was later than the estimate, down by
/// kRise / 99 where it was not: in balance one tick in a hundred is later. No history is kept, a single
/// hiccup of any length counts for one step (a maximum would leave the wall soft for seconds after it;
/// what a late tick gives the hand is the passivity controller's to take back), and no step changes the
/// stiffness by more than kRise. A servo that becomes twice as slow is known after 15 ticks; one that is
/// fast again after some 1,400.
///
/// Never less than the nominal period, which a paced loop keeps on average: short ticks that make up for a
/// late one say nothing.
class PeriodMeter {
 public:
  static constexpr double kRise = 0.05;          ///< Of a step up, relative.
  static constexpr double kQuantile = 0.99;      ///< Of the ticks that are no later than the estimate.
  static constexpr double kLongestPeriod = 0.1;  ///< A servo slower than that is none [s].

  /// How much longer than the estimate the held period may be before it follows down: the estimate of an
  /// uneven servo is never at rest, and a hand that leans on a wall would feel the stiffness come and go with
  /// it.
  static constexpr double kPlay = 0.3;
  /// What the held period comes nearer to the nominal one in a tick on time, where the estimate is there
  /// already, relative: a hiccup is forgotten within half a minute, unnoticed.
  static constexpr double kForget = 5e-6;

  /// @param nominal  What the servo is meant to keep [s]; held to (0, kLongestPeriod], 1 ms if not finite.
  explicit PeriodMeter(double nominal = 1e-3) noexcept;

  /// @param elapsed  Since the tick before [s]. Not finite or <= 0: left out. Real-time safe.
  void add(double elapsed) noexcept;

  /// The estimate [s], from the nominal period up to kLongestPeriod.
  double period() const noexcept { return period_; }
  /// What stiffness is to be reckoned with [s]: never less than the estimate, and steady while that wanders
  /// by less than kPlay.
  double heldPeriod() const noexcept { return held_; }
  double nominal() const noexcept { return nominal_; }

 private:
  double nominal_;
  double period_, held_;
};

}  // namespace nearfit
