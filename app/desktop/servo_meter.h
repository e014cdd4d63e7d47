#pragma once

#include <QElapsedTimer>

#include "device/servo/servo_loop.h"
#include "ui/servo_status.h"

namespace nearfit::desktop {

/// Rate and percentiles of a servo for its user, every half second.
class ServoMeter {
 public:
  void restart();
  void see(const ServoSnapshot& snapshot);
  bool isDue() const { return since_.elapsed() >= kEveryMs; }
  /// Puts them into the status; the next are due half a second later.
  void measure(const ServoLoop& loop, ui::ServoStatus& status);

 private:
  static constexpr qint64 kEveryMs = 500;

  QElapsedTimer since_;
  std::uint64_t ticks_ = 0;  ///< The tick since which the rate is measured; 0 before the first.
  double time_ = 0.0;        ///< Of that tick, by the servo's clock [s].
};

}  // namespace nearfit::desktop
