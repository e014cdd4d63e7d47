#pragma once

#include <cstdint>

#include "core/haptics/haptic_settings.h"

namespace nearfit {

/// The motions of the hand that count, as a user chooses them. In a plane the hand moves and turns about the
/// plane's normal, as on a table; along an axis it only moves.
enum class MotionFreedom : std::uint8_t {
  All,
  PlaneXy,
  PlaneYz,
  PlaneZx,
  AlongX,
  AlongY,
  AlongZ,
  Shifts,  ///< Translation in all directions, no rotation.
  Turns,   ///< Rotation about all axes, no translation.
  Other,   ///< Any other set of locks.
};
/// Number of enumerators.
inline constexpr int kMotionFreedoms = 10;

/// `mapping` with the locks that leave this freedom; unchanged for Other.
WorkspaceMapping withFreedom(const WorkspaceMapping& mapping, MotionFreedom freedom) noexcept;

/// The freedom that the mapping's locks leave.
MotionFreedom freedomOf(const WorkspaceMapping& mapping) noexcept;

}  // namespace nearfit
