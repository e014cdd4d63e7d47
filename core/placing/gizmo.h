#pragma once

#include <array>
#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// The parts of a gizmo that can be grabbed.
enum class GizmoGrip : std::uint8_t {
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

inline constexpr std::array kArrows{GizmoGrip::MoveX, GizmoGrip::MoveY, GizmoGrip::MoveZ};
inline constexpr std::array kPlanes{GizmoGrip::PlaneX, GizmoGrip::PlaneY, GizmoGrip::PlaneZ};
inline constexpr std::array kRings{GizmoGrip::TurnX, GizmoGrip::TurnY, GizmoGrip::TurnZ};

constexpr bool isArrow(GizmoGrip handle) noexcept {
  return handle >= GizmoGrip::MoveX && handle <= GizmoGrip::MoveZ;
}
constexpr bool isPlane(GizmoGrip handle) noexcept {
  return handle >= GizmoGrip::PlaneX && handle <= GizmoGrip::PlaneZ;
}
/// True if the handle rotates; the others translate.
constexpr bool isRing(GizmoGrip handle) noexcept {
  return handle >= GizmoGrip::TurnX && handle <= GizmoGrip::TurnView;
}

/// Axis perpendicular to the plane of an Across mode: 0, 1 or 2; -1 for other modes.
constexpr int axisOf(GizmoMode mode) noexcept {
  return mode < GizmoMode::AcrossX ? -1 : static_cast<int>(mode) - static_cast<int>(GizmoMode::AcrossX);
}

/// Axis of a handle: 0, 1 or 2; -1 for None and the view's handles.
constexpr int axisOf(GizmoGrip handle) noexcept {
  if (handle == GizmoGrip::None || handle == GizmoGrip::MoveFree || handle == GizmoGrip::TurnView) return -1;
  const int first = isArrow(handle)   ? static_cast<int>(GizmoGrip::MoveX)
                    : isPlane(handle) ? static_cast<int>(GizmoGrip::PlaneX)
                                      : static_cast<int>(GizmoGrip::TurnX);
  return static_cast<int>(handle) - first;
}

}  // namespace nearfit
