#include "core/placing/scale_bar.h"

#include <cmath>
#include <initializer_list>

namespace nearfit {

double scaleBarLength(double max, double unit) noexcept {
  // A length that just fits must not be left out because of rounding.
  constexpr double kSlack = 1.0 + 1e-9;
  const double room = max / unit;
  if (!(max > 0.0) || !(unit > 0.0) || !std::isfinite(room) || !(room > 0.0)) return 0.0;
  const double power = std::pow(10.0, std::floor(std::log10(room)));
  double units = 0.0;
  // The logarithm may be rounded across a power of ten, either way.
  for (const double step : {0.5, 1.0, 2.0, 5.0, 10.0}) {
    if (step * power <= room * kSlack) units = step * power;
  }
  return units * unit;
}

}  // namespace nearfit
