#pragma once

#include <QMetaType>
#include <QString>
#include <cstdint>

#include "core/haptics/device_limits.h"

namespace nearfit::ui {

/// Who holds the moving part while the servo runs.
enum class Hand : std::uint8_t {
  Scripted,  ///< A scripted hand repeats a smooth sweep.
  Manual,    ///< Numbers, keys and mouse.
  Device,    ///< A hand that holds a device.
};

/// What the window shows about the servo; times in [s].
struct ServoStatus {
  bool isRunning = false;
  /// A device is being opened, which may take seconds; nothing runs yet.
  bool isOpening = false;
  double openingFraction = 0.0;  ///< 0 as long as it is not known.
  Hand hand = Hand::Scripted;
  QString deviceId;     ///< Of a device in hand (DeviceChoice::id); empty for other hands.
  QString deviceState;  ///< What state it is in, in words.
  bool isUncalibrated = false;
  bool isArmable = false;  ///< It pushes, when it is armed.
  bool isArmed = false;
  bool isFaulted = false;   ///< Until it is reset.
  bool isBusy = false;      ///< It is being armed, calibrated or reset.
  bool isClutched = false;  ///< By the window's clutch.
  /// Of a device that reports its poses: how many come in a second [Hz], how far the time between two is off
  /// its mean [s], and how many are missing or damaged since it was taken in hand. 0 where it does not.
  double reportRate = 0.0, reportJitter = 0.0;
  std::uint64_t reportsLost = 0;
  double rate = 0.0;         ///< Ticks per second over the last half second or so [Hz].
  DeviceLimits device;       ///< Of what is in hand, or the usual ones.
  double nominalRate = 0.0;  ///< What the rate should be [Hz].
  double latenessP99 = 0.0, latenessMax = 0.0;
  double tickP99 = 0.0, queryP99 = 0.0;
  std::uint64_t ticks = 0, overruns = 0;
  QString scheduling;  ///< What real-time service the system granted.

  bool isTaken() const { return isRunning || isOpening; }
  /// Whether ticks are lost: what is felt then is softer and later than the springs say.
  bool isTooSlow() const { return isRunning && rate > 0.0 && rate < 0.95 * nominalRate; }
};

}  // namespace nearfit::ui

Q_DECLARE_METATYPE(nearfit::ui::Hand)
Q_DECLARE_METATYPE(nearfit::ui::ServoStatus)
