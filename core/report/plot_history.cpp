#include "core/report/plot_history.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace nearfit {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Collects the samples of one column.
class Column {
 public:
  void take(double time, double value) {
    if (!std::isfinite(value)) {
      if (!hasGap_) gapTime_ = time;
      hasGap_ = true;
      return;
    }
    if (!hasValue_ || value < low_.value) low_ = {time, value};
    if (!hasValue_ || value > high_.value) high_ = {time, value};
    hasValue_ = true;
  }
  /// Appends the collected points in order of time, and starts over.
  void flush(std::vector<PlotPoint>& out) {
    const std::size_t begin = out.size();
    if (hasValue_) out.push_back(low_);
    if (hasValue_ && high_.time != low_.time) out.push_back(high_);
    if (hasGap_) out.push_back({gapTime_, kNone});
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end(),
              [](const PlotPoint& a, const PlotPoint& b) { return a.time < b.time; });
    *this = {};
  }

 private:
  bool hasValue_ = false, hasGap_ = false;
  PlotPoint low_, high_;
  double gapTime_ = 0.0;
};

PlotPoint pointOf(const PlotSample& sample, PlotChannel channel) {
  const double value = static_cast<double>(sample.value(channel));
  return {sample.time, std::isfinite(value) ? value : kNone};
}

}  // namespace

PlotSample plotSample(const MotionRow& row) noexcept {
  PlotSample sample;
  sample.time = row.time;
  const auto set = [&](PlotChannel channel, double value) {
    sample.values[static_cast<std::size_t>(channel)] = static_cast<float>(value);
  };
  set(PlotChannel::Force, glm::length(row.wrench.force));
  set(PlotChannel::Torque, glm::length(row.wrench.torque));
  const double distance = std::isfinite(row.distance) ? row.distance : kNone;
  set(PlotChannel::Clearance, row.isDistanceBound ? kNone : distance);
  set(PlotChannel::AtLeast, row.isDistanceBound ? distance : kNone);
  set(PlotChannel::TickTime, row.tickTime);
  set(PlotChannel::Lateness, row.lateness);
  return sample;
}

void PlotHistory::add(const PlotSample& sample) {
  if (!isEmpty() && sample.time < endTime()) clear();
  ++serial_;
  if (samples_.size() < capacity_) {
    samples_.push_back(sample);
    return;
  }
  samples_[first_] = sample;
  first_ = (first_ + 1) % capacity_;
}

void PlotHistory::addGap() {
  // Halfway to the earliest sample that can follow the gap.
  constexpr double kHalfTick = 5e-4;
  if (isEmpty()) return;
  PlotSample nothing;
  nothing.time = endTime() + kHalfTick;
  nothing.values.fill(std::numeric_limits<float>::quiet_NaN());
  add(nothing);
}

void PlotHistory::clear() noexcept {
  samples_.clear();
  first_ = 0;
  ++serial_;
}

std::size_t PlotHistory::indexFrom(double time) const noexcept {
  std::size_t low = 0, high = size();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    (at(middle).time < time ? low : high) = at(middle).time < time ? middle + 1 : middle;
  }
  return low;
}

void PlotHistory::envelope(PlotChannel channel, double from, double to, std::size_t columns,
                           std::vector<PlotPoint>& out) const {
  out.clear();
  const std::size_t begin = indexFrom(from), end = indexFrom(to);
  if (begin > 0) out.push_back(pointOf(at(begin - 1), channel));
  if (end - begin <= 2 * columns) {
    for (std::size_t i = begin; i < end; ++i)
      out.push_back(pointOf(at(i), channel));
  } else {
    Column column;
    std::size_t current = 0;
    const double perSecond = static_cast<double>(columns) / (to - from);
    for (std::size_t i = begin; i < end; ++i) {
      const PlotSample& sample = at(i);
      const auto place = std::min(static_cast<std::size_t>((sample.time - from) * perSecond), columns - 1);
      if (place != current) column.flush(out);
      current = place;
      column.take(sample.time, static_cast<double>(sample.value(channel)));
    }
    column.flush(out);
  }
  if (end < size()) out.push_back(pointOf(at(end), channel));
}

std::string PlotHistory::csv(double from, double to) const {
  std::string text = "t_s,force_N,torque_Nm,clearance_m,clearance_at_least_m,tick_s,lateness_s\n";
  const std::size_t size = this->size();
  for (std::size_t i = indexFrom(from); i < size && at(i).time <= to; ++i) {
    const PlotSample& sample = at(i);
    fmt::format_to(std::back_inserter(text), "{}", sample.time);
    for (const float value : sample.values) {
      text += ',';
      if (std::isfinite(value)) fmt::format_to(std::back_inserter(text), "{}", value);
    }
    text += '\n';
  }
  return text;
}

}  // namespace nearfit
