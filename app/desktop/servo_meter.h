#pragma once

#include <QElapsedTimer>

#include "device/servo/servo_loop.h"
#include "ui/servo_status.h"

namespace nearfit::desktop {

/// Rate and percentiles of a servo for its user, every half second.
class ServoMeter {
 public:
  /// @param reports  Of the device that is taken in hand.
  void restart(const ReportCounters& reports);
  void see(const ServoSnapshot& snapshot);
  bool isDue() const { return since_.elapsed() >= kEveryMs; }
  /// Puts them into the status; the next are due half a second later.
  void measure(const ServoLoop& loop, const ReportCounters& reports, ui::ServoStatus& status);

 private:
  static constexpr qint64 kEveryMs = 500;

  QElapsedTimer since_;
  ReportCounters first_, last_;  ///< When it was taken in hand, and measured last.
  std::uint64_t ticks_ = 0;      ///< The tick since which the rate is measured; 0 before the first.
  double time_ = 0.0;            ///< Of that tick, by the servo's clock [s].
};

}  // namespace nearfit::desktop
