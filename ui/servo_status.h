#pragma once

#include <QMetaType>
#include <QString>
#include <cstdint>

#include "core/haptics/device_limits.h"

namespace nearfit::ui {

/// Who holds the moving part while the servo runs.
enum class Hand : std::uint8_t {
  Scripted,  ///< A scripted hand repeats a smooth sweep.
  Manual,    ///< The numbers and the arrow keys.
};

/// What the window shows about the servo; times in [s].
struct ServoStatus {
  bool isRunning = false;
  Hand hand = Hand::Scripted;
  double rate = 0.0;         ///< Ticks per second over the last half second or so [Hz].
  DeviceLimits device;       ///< Of what is in hand, or the usual ones.
  double nominalRate = 0.0;  ///< What the rate should be [Hz].
  double latenessP99 = 0.0, latenessMax = 0.0;
  double tickP99 = 0.0, queryP99 = 0.0;
  std::uint64_t ticks = 0, overruns = 0;
  QString scheduling;  ///< What real-time service the system granted.

  /// Whether ticks are lost: what is felt then is softer and later than the springs say.
  bool isTooSlow() const { return isRunning && rate > 0.0 && rate < 0.95 * nominalRate; }
};

}  // namespace nearfit::ui

Q_DECLARE_METATYPE(nearfit::ui::Hand)
Q_DECLARE_METATYPE(nearfit::ui::ServoStatus)
