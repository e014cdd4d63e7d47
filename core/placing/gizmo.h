#pragma once

#include <array>
#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// The parts of a gizmo that can be grabbed.
enum class GizmoHandle : std::uint8_t {
  None,
  MoveX,  ///< Arrows: along an axis.
  MoveY,
  MoveZ,
  PlaneX,  ///< Squares: in the plane perpendicular to an axis.
  PlaneY,
  PlaneZ,
  MoveFree,  ///< The middle: in the view plane.
  TurnX,     ///< Rings: about an axis.
  TurnY,
  TurnZ,
  TurnView,  ///< The outer ring: about the line of sight.
};

/// Which handles a gizmo shows.
enum class GizmoMode : std::uint8_t {
  Hidden,
  Move,
  Turn,
  MoveAndTurn,
  AcrossX,  ///< For a plane across an axis: the arrow along the axis, and the rings that tilt the plane.
  AcrossY,
  AcrossZ,
};

/// Pose of a gizmo.
struct GizmoFrame {
  glm::dvec3 pivot{0.0};  ///< Centre of rotation, in the world frame [m].
  glm::dmat3 axes{1.0};   ///< Columns: x, y and z axes in the world frame; unit, mutually perpendicular.
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
/// True if the handle rotates; the others translate.
constexpr bool isRing(GizmoHandle handle) noexcept {
  return handle >= GizmoHandle::TurnX && handle <= GizmoHandle::TurnView;
}

/// Axis perpendicular to the plane of an Across mode: 0, 1 or 2; -1 for other modes.
constexpr int axisOf(GizmoMode mode) noexcept {
  return mode < GizmoMode::AcrossX ? -1 : static_cast<int>(mode) - static_cast<int>(GizmoMode::AcrossX);
}

/// Axis of a handle: 0, 1 or 2; -1 for None and the view's handles.
constexpr int axisOf(GizmoHandle handle) noexcept {
  if (handle == GizmoHandle::None || handle == GizmoHandle::MoveFree || handle == GizmoHandle::TurnView)
    return -1;
  const int first = isArrow(handle)   ? static_cast<int>(GizmoHandle::MoveX)
                    : isPlane(handle) ? static_cast<int>(GizmoHandle::PlaneX)
                                      : static_cast<int>(GizmoHandle::TurnX);
  return static_cast<int>(handle) - first;
}

}  // namespace nearfit
