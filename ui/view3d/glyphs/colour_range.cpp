#include "ui/view3d/glyphs/colour_range.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/round_number.h"

namespace nearfit::ui {
namespace {

/// The end of the scale is at least this many medians, and margins, away.
constexpr double kMedians = 2.0, kMargins = 5.0;
/// The range shrinks once a smaller step holds this much more than the wanted one: less slack makes colours flicker,
/// and with more, all minima are red.
constexpr double kSlack = 1.5;

double medianDistance(std::span<const SnapshotLmd> minima) {
  std::vector<double> distances;
  distances.reserve(minima.size());
  for (const SnapshotLmd& entry : minima)
    distances.push_back(entry.lmd.distance);
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  return *middle;
}

}  // namespace

void ColourRange::see(std::span<const SnapshotLmd> minima, double margin) {
  if (minima.empty()) return;
  const double wanted = std::max(kMedians * medianDistance(minima), kMargins * margin);
  if (!(wanted > 0.0) || !std::isfinite(wanted)) return;
  const bool isKept = hasFound_ && wanted <= found_ && roundedUp(kSlack * wanted) >= found_;
  if (!isKept) found_ = roundedUp(wanted);
  hasFound_ = true;
}

}  // namespace nearfit::ui
