#include "ui/view3d/glyphs/colour_range.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace nearfit::ui {
namespace {

/// The end of the scale is at least this many medians, and margins, away.
constexpr double kMedians = 2.0, kMargins = 5.0;
/// The range shrinks once the wanted one is smaller by this factor.
constexpr double kSlack = 4.0;

double medianDistance(std::span<const SnapshotLmd> minima) {
  std::vector<double> distances;
  distances.reserve(minima.size());
  for (const SnapshotLmd& entry : minima)
    distances.push_back(entry.lmd.distance);
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  return *middle;
}

/// Returns the smallest of 1, 2 and 5 times a power of ten that is not below a length.
/// @param length  > 0.
double roundedUp(double length) {
  constexpr double kRounding = 1e-9;
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= length * (1.0 - kRounding)) return step * power;
  }
  return 10.0 * power;
}

}  // namespace

void ColourRange::see(std::span<const SnapshotLmd> minima, double margin) {
  if (minima.empty()) return;
  const double wanted = std::max(kMedians * medianDistance(minima), kMargins * margin);
  if (!(wanted > 0.0) || !std::isfinite(wanted)) return;
  const bool isKept = hasFound_ && wanted <= found_ && kSlack * wanted >= found_;
  if (!isKept) found_ = roundedUp(wanted);
  hasFound_ = true;
}

}  // namespace nearfit::ui
