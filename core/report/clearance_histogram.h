#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/report/clearance_map.h"

namespace nearfit {

/// Area of mapped surfaces by their clearance: each sample stands for its share of a surface.
class AreaByClearance {
 public:
  AreaByClearance() = default;
  /// O(n log n).
  explicit AreaByClearance(std::span<const MappedSurface> mapped);
  explicit AreaByClearance(const MappedSurface& mapped) : AreaByClearance(std::span(&mapped, 1)) {}

  double total() const noexcept { return total_; }  ///< Of all of the surfaces [m^2].
  /// Area within the range of the map [m^2].
  double within() const noexcept { return summed_.empty() ? 0.0 : summed_.back(); }
  /// Area nearer than a distance [m^2]. O(log n).
  double nearerThan(double distance) const noexcept;
  /// Area in contact: no farther apart, or deeper, than kContactDistance [m^2].
  double inContact() const noexcept;
  /// Area deeper in another part than that [m^2].
  double overlapping() const noexcept { return nearerThan(-kContactDistance); }
  /// Least clearance [m]; nullopt if none is within the range.
  std::optional<double> least() const noexcept;
  /// Mean over the area within the range [m]; nullopt if there is none.
  std::optional<double> mean() const noexcept;
  /// Distance that half of the area from `from` to `to`, both included, is nearer than [m]; nullopt if there is none.
  /// O(log n).
  std::optional<double> median(double from, double to) const noexcept;

 private:
  std::vector<double> distances_;  ///< Ascending; without those beyond the range [m].
  std::vector<double> summed_;     ///< Area up to and with each of them [m^2].
  double total_ = 0.0;
  double moment_ = 0.0;  ///< Sum of distance times area [m^3].
};

/// Least clearance of the subject [m].
struct LeastClearance {
  double distance = 0.0;
  /// False for the depth of the deepest sample inside another part, which may be less than the greatest depth.
  bool isExact = true;
};

/// Least clearance of a map's subject; nullopt if nothing is within the range.
/// @param areas  Of the subject.
std::optional<LeastClearance> leastClearanceOf(const ClearanceMap& map,
                                               const AreaByClearance& areas) noexcept;

/// The area whose clearance is at least `from` and less than `to` [m].
struct ClearanceBin {
  double from = 0.0, to = 0.0;
  double area = 0.0;  ///< [m^2]
};

/// Bins of one width from 0 to the range, and below 0 as many as overlaps need. The lowest of more than `bins` below 0
/// holds all that is deeper. The last one holds the range itself.
/// @param range  Of the map [m]; > 0.
/// @param bins   Number from 0 to the range; > 0.
std::vector<ClearanceBin> clearanceHistogram(const AreaByClearance& areas, double range,
                                             std::size_t bins = 40);

/// The histogram as CSV: `from [m]`, `to [m]`, `area [m^2]`, `share` of the whole surface. A last row from the range to `inf`
/// has what is beyond.
std::string histogramCsv(const AreaByClearance& areas, double range);

}  // namespace nearfit
