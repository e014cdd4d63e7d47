#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/motion_recording.h"

namespace nearfit {

/// What is plotted over time.
enum class PlotChannel : std::uint8_t {
  Force,      ///< Magnitude [N].
  Torque,     ///< Magnitude [N m].
  Clearance,  ///< Least distance [m]; not a number when nothing is within the cutoff.
  TickTime,   ///< [s]
  Lateness,   ///< Of the servo behind its deadline [s].
};
inline constexpr std::size_t kPlotChannels = 5;

/// Of one tick.
struct PlotSample {
  double time = 0.0;  ///< [s]
  std::array<float, kPlotChannels> values{};

  float value(PlotChannel channel) const noexcept { return values[static_cast<std::size_t>(channel)]; }
};

PlotSample plotSample(const MotionRow& row) noexcept;

struct PlotPoint {
  double time = 0.0, value = 0.0;
};

/// The newest samples of a run, at the full rate and in bounded memory. One thread.
class PlotHistory {
 public:
  /// Four minutes and more at 1 kHz, in 8 MB.
  static constexpr std::size_t kDefaultCapacity = std::size_t{1} << 18;

  /// @param capacity  Samples that are kept; the oldest go first. > 0. Memory grows up to that.
  explicit PlotHistory(std::size_t capacity = kDefaultCapacity) : capacity_(capacity) {}

  /// A sample that is earlier than the one before begins a new run: what was there is forgotten.
  void add(const PlotSample& sample);
  /// Samples are missing after the newest: lines break there.
  void addGap();
  void clear() noexcept;

  std::size_t size() const noexcept { return samples_.size(); }
  bool isEmpty() const noexcept { return samples_.empty(); }
  /// From the oldest.
  const PlotSample& at(std::size_t index) const noexcept {
    return samples_[(first_ + index) % samples_.size()];
  }
  /// Of the oldest and the newest sample [s]; 0 when there are none.
  double beginTime() const noexcept { return isEmpty() ? 0.0 : at(0).time; }
  double endTime() const noexcept { return isEmpty() ? 0.0 : at(size() - 1).time; }
  /// Another number after each change.
  std::uint64_t serial() const noexcept { return serial_; }

  /// The index of the first sample that is no earlier than `time`; size() when there is none. O(log n).
  std::size_t indexFrom(double time) const noexcept;

  /// What a line through all samples of a span looks like that is so many pixels wide: of each of the columns
  /// of equal width the least and the greatest value, at their times, so that no peak is lost; all samples as
  /// they are where they are not more than that. The nearest sample before and after the span is there too.
  /// Where samples have no value (not finite) a point without one breaks the line.
  /// @param from, to  The span [s], from < to.   @param columns  > 0.
  /// @param out       Replaced: in the order of time, at most 3 `columns` + 4 points.
  void envelope(PlotChannel channel, double from, double to, std::size_t columns,
                std::vector<PlotPoint>& out) const;

  /// The samples from one time to another as CSV: `t_s,force_N,torque_Nm,clearance_m,tick_s,lateness_s`, with
  /// an empty field where there is no value.
  std::string csv(double from, double to) const;

 private:
  std::size_t capacity_;
  std::vector<PlotSample> samples_;  ///< A ring once it is full.
  std::size_t first_ = 0;            ///< The oldest.
  std::uint64_t serial_ = 0;
};

}  // namespace nearfit
