#pragma once

#include <QElapsedTimer>
#include <QString>

#include "device/interface/haptic_device.h"
#include "device/servo/servo_loop.h"
#include "ui/model/servo_status.h"

namespace nearfit::desktop {

/// Measures rate and percentiles of a servo for its user, every half second.
class ServoMeter {
 public:
  /// Starts anew.
  /// @param reports  Counters of the device taken in hand.
  void restart(const ReportCounters& reports);
  /// Notes the first snapshot, from which the rate is measured.
  void see(const ServoSnapshot& snapshot);
  bool isDue() const { return since_.elapsed() >= kEveryMs; }
  /// Writes the results into the status; the next are due half a second later.
  void measure(const ServoLoop& loop, const ReportCounters& reports, ui::ServoStatus& status);

 private:
  static constexpr qint64 kEveryMs = 500;

  QElapsedTimer since_;
  ReportCounters first_, last_;  ///< When it was taken in hand, and at the last measurement.
  std::uint64_t ticks_ = 0;      ///< Tick from which the rate is measured; 0 before the first.
  double time_ = 0.0;            ///< Time of that tick, by the servo's clock [s].
};

/// Tells the user in sentences what a device is doing.
/// @param isPushing  True if it can push.
/// @param note       HapticDevice::stateNote().
QString deviceText(DeviceState state, bool isPushing, const QString& note);

/// Returns what follows deviceText(), with a space before it: which axes the device does not sense, or senses and has no
/// motors for. Empty if it is not in use, or has none missing.
QString missingAxesText(DeviceState state, const DeviceInfo& info);

}  // namespace nearfit::desktop
