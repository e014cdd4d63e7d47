#include "core/report/clearance_histogram.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

namespace nearfit {

AreaByClearance::AreaByClearance(std::span<const MappedSurface> mapped) {
  struct Sample {
    double distance, area;
  };
  std::vector<Sample> samples;
  for (const MappedSurface& each : mapped) {
    const std::vector<double>& areas = each.surface->areas;
    for (std::size_t i = 0; i < areas.size(); ++i) {
      total_ += areas[i];
      if (!std::isnan(each.distances[i])) samples.push_back({each.distances[i], areas[i]});
    }
  }
  // Sums must not depend on how equal ones are ordered.
  std::ranges::stable_sort(samples, {}, &Sample::distance);
  distances_.reserve(samples.size());
  summed_.reserve(samples.size());
  double sum = 0.0;
  for (const Sample& sample : samples) {
    sum += sample.area;
    moment_ += sample.distance * sample.area;
    distances_.push_back(sample.distance);
    summed_.push_back(sum);
  }
}

double AreaByClearance::nearerThan(double distance) const noexcept {
  const auto count = std::ranges::lower_bound(distances_, distance) - distances_.begin();
  return count > 0 ? summed_[static_cast<std::size_t>(count) - 1] : 0.0;
}

double AreaByClearance::inContact() const noexcept {
  return nearerThan(std::nextafter(kContactDistance, 1.0)) - overlapping();
}

std::optional<double> AreaByClearance::least() const noexcept {
  return distances_.empty() ? std::nullopt : std::optional(distances_.front());
}

std::optional<double> AreaByClearance::mean() const noexcept {
  return within() > 0.0 ? std::optional(moment_ / within()) : std::nullopt;
}

std::optional<double> AreaByClearance::median(double from, double to) const noexcept {
  const double before = nearerThan(from),
               upTo = nearerThan(std::nextafter(to, std::numeric_limits<double>::infinity()));
  if (!(upTo > before)) return std::nullopt;
  const auto half = std::ranges::lower_bound(summed_, 0.5 * (before + upTo)) - summed_.begin();
  return distances_[static_cast<std::size_t>(half)];
}

std::optional<LeastClearance> leastClearanceOf(const ClearanceMap& map,
                                               const AreaByClearance& areas) noexcept {
  const double sampled = areas.least().value_or(std::numeric_limits<double>::infinity());
  if (sampled < -kContactDistance) return LeastClearance{sampled, false};
  // Rounding may leave a sample at the nearest point a little nearer.
  const double least = std::min(std::max(sampled, 0.0), map.leastDistance);
  return std::isfinite(least) ? std::optional(LeastClearance{least, true}) : std::nullopt;
}

std::vector<ClearanceBin> clearanceHistogram(const AreaByClearance& areas, double range, std::size_t bins) {
  const double width = range / static_cast<double>(bins), infinity = std::numeric_limits<double>::infinity();
  const double deepest = std::min(0.0, areas.least().value_or(0.0));
  const auto below = static_cast<long>(std::min(static_cast<double>(bins), std::ceil(-deepest / width)));
  std::vector<ClearanceBin> histogram;
  double before = 0.0;
  for (long i = -below; i < static_cast<long>(bins); ++i) {
    const bool isLast = i + 1 == static_cast<long>(bins);
    const double from = width * static_cast<double>(i),
                 to = isLast ? range : width * static_cast<double>(i + 1);
    const double nearer = areas.nearerThan(isLast ? infinity : to);
    histogram.push_back({from, to, nearer - before});
    before = nearer;
  }
  return histogram;
}

std::string histogramCsv(const AreaByClearance& areas, double range) {
  std::string text = "from [m],to [m],area [m^2],share\n";
  const double total = areas.total();
  const auto add = [&](double from, double to, double area) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", from, to, area,
                   total > 0.0 ? area / total : 0.0);
  };
  for (const ClearanceBin& bin : clearanceHistogram(areas, range))
    add(bin.from, bin.to, bin.area);
  add(range, std::numeric_limits<double>::infinity(), std::max(0.0, total - areas.within()));
  return text;
}

}  // namespace nearfit
