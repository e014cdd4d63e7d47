#pragma once

#include <cstdint>
#include <optional>

#include "core/math/rigid_transform.h"

namespace nearfit {

/// Fading of forces with the age of a pose: full up to `hold`, then linearly down to zero at `silence`.
struct PoseFade {
  double hold = 5e-3;      ///< [s]; five reports of a device at 1 kHz.
  double silence = 20e-3;  ///< [s]
};

/// Input from a device for one tick.
struct HandleInput {
  RigidTransform pose;      ///< Pose of the device's handle, in the device's frame.
  double age = 0.0;         ///< Time since the device measured it [s]; forces fade with it.
  PoseFade patience{};      ///< How forces fade with the age.
  bool isClutched = false;  ///< The hand repositions the device; the part stays.
  /// False if the device senses how the hand turns but has no motors against it (a Touch, an omega.6). Then no torque
  /// is rendered, and the proxy gives way by turning: the turning hand does no work, so what its torque would have held
  /// back must not come out as a force. With springs the passivity
  /// controller alone limits this.
  bool isTorqueFelt = true;
  bool isArmed = true;  ///< The device may render force. When it is armed, the force ramps up from zero.
  /// True if the device has a frame of its own: the handle starts at the part, wherever the device is.
  /// Otherwise the device's poses are world poses.
  bool hasOwnFrame = false;
  /// In this tick the handle returns to the part's pose and leads on from there. Only for devices that render
  /// no force, since the force ends at once.
  bool returnsToPart = false;
  std::uint64_t buttons = 0;  ///< Buttons that are down; bit 0 is the first.
  /// Opening angle of its gripper, 0 if closed [rad]; only shown and recorded.
  std::optional<double> grip{};
};

}  // namespace nearfit
