#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/servo/motion_recording.h"

namespace nearfit {

/// Quantities plotted over time.
enum class PlotChannel : std::uint8_t {
  Force,      ///< Magnitude [N].
  Torque,     ///< Magnitude [N m].
  Clearance,  ///< Min distance [m]; NaN if nothing is within the cutoff, or only a bound is known.
  AtLeast,    ///< Lower bound on the min distance where only that is known, else NaN [m].
  TickTime,   ///< [s]
  Lateness,   ///< Delay of the tick after its deadline [s].
};
inline constexpr std::size_t kPlotChannels = 6;

/// Values of one tick.
struct PlotSample {
  double time = 0.0;  ///< Since the servo started [s].
  /// By PlotChannel, in its unit.
  std::array<float, kPlotChannels> values{};

  float value(PlotChannel channel) const noexcept { return values[static_cast<std::size_t>(channel)]; }
};

/// Takes the plotted values from a row.
PlotSample plotSample(const MotionRow& row) noexcept;

/// A point of a line: time [s], value in the channel's unit; NaN breaks the line.
struct PlotPoint {
  double time = 0.0, value = 0.0;
};

/// The newest samples of a run, at full rate and in bounded memory. Single-threaded.
class PlotHistory {
 public:
  /// More than four minutes at 1 kHz, in 8 MB.
  static constexpr std::size_t kDefaultCapacity = std::size_t{1} << 18;

  /// @param capacity  Max samples kept; the oldest are dropped. > 0. Memory grows up to that.
  explicit PlotHistory(std::size_t capacity = kDefaultCapacity) : capacity_(capacity) {}

  /// Adds a sample. One that is earlier than the last starts a new run and clears the history.
  void add(const PlotSample& sample);
  /// Marks samples as missing after the newest, which breaks lines there.
  void addGap();
  void clear() noexcept;

  std::size_t size() const noexcept { return samples_.size(); }
  bool isEmpty() const noexcept { return samples_.empty(); }
  /// Sample by index from the oldest.
  const PlotSample& at(std::size_t index) const noexcept {
    return samples_[(first_ + index) % samples_.size()];
  }
  /// Times of the oldest and newest samples [s]; 0 if there are none.
  double beginTime() const noexcept { return isEmpty() ? 0.0 : at(0).time; }
  double endTime() const noexcept { return isEmpty() ? 0.0 : at(size() - 1).time; }
  /// Changes with each change of the history.
  std::uint64_t serial() const noexcept { return serial_; }

  /// Index of the first sample that is not before `time` [s]; size() if there is none. O(log n).
  std::size_t indexFrom(double time) const noexcept;

  /// The line through the samples of a span, reduced to a width in columns (pixels).
  ///
  /// Returns the min and max of each column, at their times, so that no peak is lost; or all samples if there
  /// are at most two per column. Adds the nearest sample before and after the span. Values that are not
  /// finite give a NaN point, which breaks the line.
  /// @param from, to  The span [s]; from < to.
  /// @param columns   > 0.
  /// @param out       Overwritten: in order of time, at most 3 `columns` + 4 points.
  void envelope(PlotChannel channel, double from, double to, std::size_t columns,
                std::vector<PlotPoint>& out) const;

  /// Samples from `from` to `to` [s], inclusive, as CSV:
  /// `t_s,force_N,torque_Nm,clearance_m,clearance_at_least_m,tick_s,lateness_s`. The field is empty if a value is not finite.
  std::string csv(double from, double to) const;

 private:
  std::size_t capacity_;
  std::vector<PlotSample> samples_;  ///< A ring buffer once it is full.
  std::size_t first_ = 0;            ///< Index of the oldest.
  std::uint64_t serial_ = 0;
};

}  // namespace nearfit
