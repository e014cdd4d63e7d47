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
/// A hand rests while the wanted range keeps to this share of itself for so long [s]: less than a tremor, and longer
/// than a hand that turns back.
constexpr double kStillShare = 0.05, kRestTime = 0.5;

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

void ColourRange::see(std::span<const SnapshotLmd> minima, double margin, double time) {
  const double wanted = minima.empty() ? 0.0 : std::max(kMedians * medianDistance(minima), kMargins * margin);
  if (!(wanted > 0.0) || !std::isfinite(wanted)) {
    isRestSeen_ = true;
    restWanted_ = 0.0;
    return;
  }
  const bool isStill =
      hasFound_ && time >= restFrom_ && std::abs(wanted - restWanted_) <= kStillShare * restWanted_;
  if (!isStill) {
    restWanted_ = wanted;
    restFrom_ = time;
    isRestSeen_ = false;
  }
  wanted_ = wanted;
  // Once in each rest: a range at the edge of a step would come and go.
  const bool isRestNew = hasRested(time);
  const bool isKept = hasFound_ && !isRestNew && wanted <= found_ && roundedUp(kSlack * wanted) >= found_;
  if (!isKept) found_ = roundedUp(wanted);
  isRestSeen_ = isRestSeen_ || isRestNew;
  hasFound_ = true;
}

bool ColourRange::hasRested(double time) const noexcept {
  return hasFound_ && !isRestSeen_ && time - restFrom_ >= kRestTime;
}

bool ColourRange::isDue(double time) const noexcept {
  return hasRested(time) && roundedUp(wanted_) < found_;
}

}  // namespace nearfit::ui
