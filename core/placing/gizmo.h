#pragma once

#include <array>
#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// What of a gizmo can be grabbed.
enum class GizmoHandle : std::uint8_t {
  None,
  MoveX,  ///< Arrows: along an axis.
  MoveY,
  MoveZ,
  PlaneX,  ///< Squares: in the plane across an axis.
  PlaneY,
  PlaneZ,
  MoveFree,  ///< The middle: in the plane of the view.
  TurnX,     ///< Rings: about an axis.
  TurnY,
  TurnZ,
  TurnView,  ///< The outer ring: about the direction of sight.
};

/// What a gizmo offers.
enum class GizmoMode : std::uint8_t {
  Hidden,
  Move,
  Turn,
  MoveAndTurn,
  AcrossX,  ///< Of a plane across an axis: the arrow along it, and the rings that tilt the plane.
  AcrossY,
  AcrossZ,
};

/// Where a gizmo stands.
struct GizmoFrame {
  glm::dvec3 pivot{0.0};  ///< In the world [m]; turns are about it.
  glm::dmat3 axes{1.0};   ///< Columns: x, y and z in the world; unit and square to each other.
};

inline constexpr std::array kArrows{GizmoHandle::MoveX, GizmoHandle::MoveY, GizmoHandle::MoveZ};
inline constexpr std::array kPlanes{GizmoHandle::PlaneX, GizmoHandle::PlaneY, GizmoHandle::PlaneZ};
inline constexpr std::array kRings{GizmoHandle::TurnX, GizmoHandle::TurnY, GizmoHandle::TurnZ};

constexpr bool isArrow(GizmoHandle handle) noexcept {
  return handle >= GizmoHandle::MoveX && handle <= GizmoHandle::MoveZ;
}
constexpr bool isPlane(GizmoHandle handle) noexcept {
  return handle >= GizmoHandle::PlaneX && handle <= GizmoHandle::PlaneZ;
}
/// Whether it turns the part; the others shift it.
constexpr bool isRing(GizmoHandle handle) noexcept {
  return handle >= GizmoHandle::TurnX && handle <= GizmoHandle::TurnView;
}

/// The axis that a mode's plane lies across: 0, 1 or 2; -1 for all others.
constexpr int axisOf(GizmoMode mode) noexcept {
  return mode < GizmoMode::AcrossX ? -1 : static_cast<int>(mode) - static_cast<int>(GizmoMode::AcrossX);
}

/// Of which axis a handle is: 0, 1 or 2; -1 for those of the view.
constexpr int axisOf(GizmoHandle handle) noexcept {
  if (handle == GizmoHandle::None || handle == GizmoHandle::MoveFree || handle == GizmoHandle::TurnView)
    return -1;
  const int first = isArrow(handle)   ? static_cast<int>(GizmoHandle::MoveX)
                    : isPlane(handle) ? static_cast<int>(GizmoHandle::PlaneX)
                                      : static_cast<int>(GizmoHandle::TurnX);
  return static_cast<int>(handle) - first;
}

}  // namespace nearfit
