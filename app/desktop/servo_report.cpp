#include "app/desktop/servo_report.h"

#include <QObject>

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

QString deviceText(DeviceState state, bool isPushing, const QString& note) {
  const QString because = note.isEmpty() ? QString() : QStringLiteral(": ") + note;
  switch (state) {
    case DeviceState::Armed:
      return isPushing ? QObject::tr("Armed: it pushes.")
                       : QObject::tr("It moves the part; it does not push.");
    case DeviceState::Ready:
      return QObject::tr("Not armed: it moves the part and does not push.");
    case DeviceState::Uncalibrated:
      return QObject::tr("Not calibrated%1.").arg(because);
    case DeviceState::Fault:
      return QObject::tr("Stopped%1. It does not push until you reset and arm it again.").arg(because);
    case DeviceState::Lost:
      return QObject::tr("Lost%1.").arg(because);
    default:
      return {};
  }
}

QString missingAxesText(DeviceState state, const DeviceInfo& info) {
  if (state != DeviceState::Ready && state != DeviceState::Armed) return {};
  if (info.sensedAxes == 3)
    return QObject::tr(" It senses no turning: the part turns only where it touches.");
  if (info.isTurningUnfelt())
    return QObject::tr(" It has no motors for torque: you feel forces, but not what stops a turn.");
  return {};
}

}  // namespace nearfit::desktop
