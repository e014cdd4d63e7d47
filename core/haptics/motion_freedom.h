#pragma once

#include <cstdint>

#include "core/haptics/haptic_settings.h"

namespace nearfit {

/// Which motions of the hand count, as a user asks for them. In a plane the hand slides and turns about the
/// plane's normal, as on a table; along an axis it slides alone.
enum class MotionFreedom : std::uint8_t {
  All,
  PlaneXy,
  PlaneYz,
  PlaneZx,
  AlongX,
  AlongY,
  AlongZ,
  Shifts,  ///< In all directions, without a turn.
  Turns,   ///< About all axes, in its place.
  Other,   ///< By locks that are none of these.
};
inline constexpr int kMotionFreedoms = 10;

/// The locks of a mapping that leave this freedom; Other leaves those that there are.
WorkspaceMapping withFreedom(const WorkspaceMapping& mapping, MotionFreedom freedom) noexcept;

/// What the locks of a mapping leave.
MotionFreedom freedomOf(const WorkspaceMapping& mapping) noexcept;

}  // namespace nearfit
