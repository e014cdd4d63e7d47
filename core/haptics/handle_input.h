#pragma once

#include "core/math/rigid_transform.h"

namespace nearfit {

/// What a tick gets from a device.
struct HandleInput {
  RigidTransform pose;      ///< Where the device's handle is, in the device's frame.
  double age = 0.0;         ///< Since the device measured it [s]; forces fade as it grows.
  bool isClutched = false;  ///< The hand repositions the device: the part stays meanwhile.
};

}  // namespace nearfit
