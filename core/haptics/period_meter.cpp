#include "core/haptics/period_meter.h"

#include <algorithm>
#include <cmath>

namespace nearfit {
namespace {

/// Default period of a servo [s].
constexpr double kUsualPeriod = 1e-3;
/// Min period [s]; the processor's clock is no finer.
constexpr double kShortestPeriod = 1e-9;

}  // namespace

PeriodMeter::PeriodMeter(double nominal) noexcept
    : nominal_(std::isfinite(nominal) ? std::clamp(nominal, kShortestPeriod, kLongestPeriod) : kUsualPeriod),
      period_(nominal_),
      held_(nominal_) {}

void PeriodMeter::add(double elapsed) noexcept {
  if (!std::isfinite(elapsed) || !(elapsed > 0.0)) return;
  if (elapsed > period_) {
    period_ = std::min({elapsed, period_ * (1.0 + kRise), kLongestPeriod});
  } else {
    constexpr double kFall = kRise * (1.0 - kQuantile) / kQuantile;
    period_ = std::max(period_ * (1.0 - kFall), nominal_);
  }
  if (period_ == nominal_) held_ *= 1.0 - kForget;
  held_ = std::max(period_, std::min(held_, (1.0 + kPlay) * period_));
}

}  // namespace nearfit
