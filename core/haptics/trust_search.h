#pragma once

#include <algorithm>

namespace nearfit {

/// Finds s in [0, 1] at which a continuous, nearly linear function that is zero or small at s = 0 lies
/// within [kMinShare, 1] of a bound; s = 1 if it is below the bound there. Regula falsi, with halving
/// when it stalls. The caller evaluates: until isDone(), compute the value at scale() and report() it.
/// Real-time safe.
class TrustSearch {
 public:
  static constexpr double kMinShare = 0.9;
  /// Share of the bound that is aimed at: rounding and kinks may put the value beside it.
  static constexpr double kAim = 0.95;
  /// After this many values, all above the bound, s = 0 is tried whatever the last two predict.
  static constexpr unsigned kPatience = 4;

  /// @param mostValues  Max values to evaluate.
  TrustSearch(double bound, unsigned mostValues) noexcept : bound_(bound), mostValues_(mostValues) {}

  /// The s to evaluate next.
  double scale() const noexcept { return scale_; }
  bool isDone() const noexcept { return isDone_; }

  /// Records the value at scale(). Returns true if it is the best so far: within the bound, at the
  /// largest such s.
  bool report(double value) noexcept {
    ++values_;
    const bool isWithin = value <= bound_;
    if (isWithin) {
      low_ = scale_;
      lowValue_ = value;
    } else {
      // No value within the bound is known: extrapolate the last two to s = 0.
      if (low_ < 0.0 && values_ > 1)
        lowValue_ = std::max(0.0, value - scale_ * (highValue_ - value) / (high_ - scale_));
      high_ = scale_;
      highValue_ = value;
    }
    const bool isEnough = isWithin && (scale_ == 1.0 || value >= kMinShare * bound_);
    isDone_ = isEnough || values_ == mostValues_ || high_ <= std::max(low_, 0.0);
    repeats_ = isWithin == lastWasWithin_ ? repeats_ + 1 : 0;
    lastWasWithin_ = isWithin;
    if (!isDone_) scale_ = next();
    return isWithin;
  }

 private:
  double next() const noexcept {
    if (low_ < 0.0 && (values_ == kPatience || lowValue_ >= kAim * bound_)) return 0.0;
    const double from = std::max(low_, 0.0);
    if (low_ >= 0.0 && repeats_ >= 2) return 0.5 * (from + high_);
    const double share = (kAim * bound_ - lowValue_) / (highValue_ - lowValue_);
    return from + std::clamp(share, 0.0, 1.0) * (high_ - from);
  }

  double bound_, scale_ = 1.0;
  double low_ = -1.0, lowValue_ = 0.0;  ///< low_ is negative while no value within the bound is known.
  double high_ = 1.0, highValue_ = 0.0;
  unsigned mostValues_, values_ = 0, repeats_ = 0;
  bool lastWasWithin_ = false, isDone_ = false;
};

}  // namespace nearfit
