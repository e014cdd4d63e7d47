#include "app/desktop/servo_meter.h"

namespace nearfit::desktop {

void ServoMeter::restart(const ReportCounters& reports) {
  since_.start();
  first_ = last_ = reports;
  ticks_ = 0;
}

void ServoMeter::see(const ServoSnapshot& snapshot) {
  if (ticks_ != 0) return;
  ticks_ = snapshot.tick;
  time_ = snapshot.time;
}

void ServoMeter::measure(const ServoLoop& loop, const ReportCounters& reports, ui::ServoStatus& status) {
  constexpr double kMilli = 1e-3;
  const double passed = kMilli * static_cast<double>(since_.restart());
  const ServoStatistics statistics = loop.statistics();
  status.reportRate = passed > 0.0 ? static_cast<double>(reports.poses - last_.poses) / passed : 0.0;
  status.reportJitter = statistics.reportJitter;
  status.reportsLost = reports.missing - first_.missing + reports.rejected - first_.rejected;
  last_ = reports;
  // From snapshots: statistics advance in steps of many ticks, too coarse for half a second.
  const ServoSnapshot& snapshot = loop.snapshot();
  const double seconds = snapshot.time - time_;
  status.rate = seconds > 0.0 ? static_cast<double>(snapshot.tick - ticks_) / seconds : 0.0;
  ticks_ = snapshot.tick;
  time_ = snapshot.time;
  status.ticks = statistics.ticks;
  status.overruns = statistics.overruns;
  status.latenessP99 = statistics.lateness.percentile(0.99);
  status.latenessMax = statistics.lateness.max();
  status.tickP99 = statistics.tickTime.percentile(0.99);
  status.queryP99 = statistics.queryTime.percentile(0.99);
}

}  // namespace nearfit::desktop
