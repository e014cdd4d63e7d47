#pragma once

namespace nearfit {

/// Estimates the servo's period for the stability bound: the 99th percentile of the time measured
/// between ticks.
///
/// Follows the percentile in small steps: up by kRise after a tick later than the estimate, else down by
/// kRise / 99, so that in balance one tick in a hundred is later. It keeps no history. A single hiccup of any
/// length counts as one step (a max would leave the wall soft for seconds; the passivity controller takes
/// back what a late tick gives the hand), and no step changes the stiffness by more than kRise. A servo that
/// becomes twice as slow is known after 15 ticks, one that is fast again after some 1,400.
///
/// Never below the nominal period, which a paced loop keeps on average: short ticks that make up for a late
/// one carry no information. Real-time safe.
class PeriodMeter {
 public:
  static constexpr double kRise = 0.05;      ///< Relative size of a step up.
  static constexpr double kQuantile = 0.99;  ///< Share of ticks no later than the estimate.
  /// Max period [s]; a slower servo is unusable.
  static constexpr double kLongestPeriod = 0.1;

  /// Max excess of the held period over the estimate before it follows down, relative. The estimate of an
  /// uneven servo never rests, and a hand that leans on a wall would feel the stiffness vary with it.
  static constexpr double kPlay = 0.3;
  /// While the estimate is at the nominal period, the held period falls towards it by this per tick,
  /// relative: a hiccup is forgotten within half a minute, unnoticed.
  static constexpr double kForget = 5e-6;

  /// @param nominal  Intended period [s]; clamped to (0, kLongestPeriod], 1 ms if not finite.
  explicit PeriodMeter(double nominal = 1e-3) noexcept;

  /// Records the time since the last tick [s]; ignored unless finite and > 0.
  void add(double elapsed) noexcept;

  /// The estimate [s], from the nominal period to kLongestPeriod.
  double period() const noexcept { return period_; }
  /// Period to compute stiffness with [s]: never below the estimate, and steady while that varies by
  /// less than kPlay.
  double heldPeriod() const noexcept { return held_; }
  /// Intended period [s].
  double nominal() const noexcept { return nominal_; }

 private:
  double nominal_;
  double period_, held_;
};

}  // namespace nearfit
