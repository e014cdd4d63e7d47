#include "core/mesh/coordinate_rounding.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

namespace nearfit {
namespace {

/// Number of points looked at. So many coordinates of full precision all look short with no chance.
constexpr std::size_t kPointsSampled = 512;
/// A decimal number of more digits may be any double.
constexpr int kMaxDigits = 15;

/// Number of digits of the shortest decimal number that is read as `x`.
int digitsOf(double x) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), std::abs(x), std::chars_format::scientific);
  const std::string_view written(text.data(), static_cast<std::size_t>(end.ptr - text.data()));
  const std::string_view mantissa = written.substr(0, written.find('e'));
  return static_cast<int>(mantissa.size()) - (mantissa.find('.') != std::string_view::npos ? 1 : 0);
}

}  // namespace

double coordinateRounding(std::span<const glm::dvec3> points) {
  double largest = 0.0;
  bool areSingle = true;
  int digits = 0;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kPointsSampled);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const double x : {points[i].x, points[i].y, points[i].z}) {
      if (!std::isfinite(x)) continue;
      largest = std::max(largest, std::abs(x));
      if (i % stride != 0) continue;
      areSingle = areSingle && static_cast<double>(static_cast<float>(x)) == x;
      if (digits <= kMaxDigits) digits = std::max(digits, digitsOf(x));
    }
  }
  if (!(largest > 0.0)) return 0.0;
  // Half a unit in the last place of the largest coordinate.
  constexpr double kHalf = 0.5;
  double rounding = std::numeric_limits<double>::infinity();
  if (areSingle) rounding = kHalf * static_cast<double>(std::numeric_limits<float>::epsilon()) * largest;
  if (digits <= kMaxDigits)
    rounding = std::min(rounding, kHalf * std::pow(10.0, std::floor(std::log10(largest)) - digits + 1));
  const double least = kHalf * std::numeric_limits<double>::epsilon() * largest;
  return std::isfinite(rounding) ? std::max(rounding, least) : least;
}

}  // namespace nearfit
