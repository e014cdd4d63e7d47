#pragma once

#include <QMetaType>
#include <QString>
#include <cstdint>

#include "core/haptics/device_limits.h"

namespace nearfit::ui {

/// Who holds the moving part while the servo runs.
enum class Hand : std::uint8_t {
  Scripted,  ///< A program that repeats a smooth sweep.
  Manual,    ///< Driven by numbers, keys and mouse.
  Device,    ///< A person's hand, through a device.
};

/// The servo's state as the window shows it; times in [s].
struct ServoStatus {
  bool isRunning = false;
  /// A device is being opened, which may take seconds; the servo does not run yet.
  bool isOpening = false;
  double openingFraction = 0.0;  ///< 0 while unknown.
  Hand hand = Hand::Scripted;
  QString deviceId;     ///< The device in hand (DeviceChoice::id); empty for other hands.
  QString deviceState;  ///< The device's state in words.
  bool isUncalibrated = false;
  bool isArmable = false;  ///< It renders forces once armed.
  bool isArmed = false;
  bool isFaulted = false;   ///< Stays true until the user resets the device.
  bool isBusy = false;      ///< Being armed, calibrated or reset.
  bool isClutched = false;  ///< By the window's clutch.
  /// For a device that reports its poses: reports per second [Hz], deviation of their interval from its mean
  /// [s], and how many were lost or damaged since it was taken in hand. Else 0.
  double reportRate = 0.0, reportJitter = 0.0;
  std::uint64_t reportsLost = 0;
  double rate = 0.0;                            ///< Ticks per second over about the last half second [Hz].
  DeviceLimits device;                          ///< Limits of the device in hand, or the defaults.
  double nominalRate = 0.0;                     ///< The intended rate [Hz].
  double latenessP99 = 0.0, latenessMax = 0.0;  ///< How late ticks begin.
  double tickP99 = 0.0, queryP99 = 0.0;         ///< Time of a tick, and of its queries.
  std::uint64_t ticks = 0, overruns = 0;        ///< Ticks run; ticks skipped as too late.
  QString scheduling;                           ///< Real-time scheduling that the system granted.

  /// True if the servo runs or is about to.
  bool isTaken() const { return isRunning || isOpening; }
  /// True if ticks are being lost: contact then feels softer and later than set.
  bool isTooSlow() const { return isRunning && rate > 0.0 && rate < 0.95 * nominalRate; }
};

}  // namespace nearfit::ui

Q_DECLARE_METATYPE(nearfit::ui::Hand)
Q_DECLARE_METATYPE(nearfit::ui::ServoStatus)
