#pragma once

#include <cmath>
#include <initializer_list>

namespace nearfit {

/// Returns the smallest of 1, 2 and 5 times a power of ten that is not below a number, but for rounding.
/// @param number  Finite, > 0.
inline double roundedUp(double number) noexcept {
  constexpr double kRounding = 1e-9;
  const double power = std::pow(10.0, std::floor(std::log10(number)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= number * (1.0 - kRounding)) return step * power;
  }
  return 10.0 * power;
}

}  // namespace nearfit
