#pragma once

#include <cstdint>

#include "core/math/rigid_transform.h"

namespace nearfit {

/// How old a pose may be: in full up to `hold`, then it counts for less and less, and for nothing from
/// `silence` on.
struct PosePatience {
  double hold = 5e-3;      ///< [s]: five reports of a device at 1 kHz.
  double silence = 20e-3;  ///< [s]
};

/// What a tick gets from a device.
struct HandleInput {
  RigidTransform pose;      ///< Where the device's handle is, in the device's frame.
  double age = 0.0;         ///< Since the device measured it [s]; forces fade as it grows.
  PosePatience patience{};  ///< With that age.
  bool isClutched = false;  ///< The hand repositions the device: the part stays meanwhile.
  bool isArmed = true;      ///< The device may push: when it is armed, the force begins from nothing.
  /// The device has a frame of its own: the handle begins where the part is, wherever the device is. Else
  /// poses of the device are poses in the world.
  bool hasOwnFrame = false;
  /// In this tick the handle goes back to where the part is, and leads it on from there. For devices that do
  /// not push: what is felt ends at once.
  bool isLettingGo = false;
  std::uint64_t buttons = 0;  ///< That are down; bit 0: the first.
};

}  // namespace nearfit
