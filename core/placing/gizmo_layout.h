#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/placing/gizmo.h"
#include "core/placing/view_projection.h"

namespace nearfit {

class GizmoDrag;

/// What is drawn and grabbed of one handle: a line or an area, in pixels.
struct GizmoFigure {
  GizmoGrip handle = GizmoGrip::None;
  std::vector<glm::dvec2> points;
  bool isArea = false;     ///< Closed and filled; otherwise an open line.
  double opacity = 1.0;    ///< Below 1 if the view shows too little of it to be useful.
  bool isFarSide = false;  ///< The part of a ring behind the gizmo: cannot be grabbed.
};

/// The gizmo as a view shows it: of constant size on the screen. What is drawn can be grabbed, by
/// distance on the screen.
class GizmoLayout {
 public:
  /// All sizes are in pixels.
  static constexpr double kArrowLength = 92.0, kLongArrowLength = 112.0;  ///< Long: beyond the rings.
  static constexpr double kRingRadius = 80.0, kViewRingRadius = 98.0;
  static constexpr double kMiddleRadius = 8.0;
  /// Max distance of the pointer from a line that it grabs.
  static constexpr double kGrabDistance = 7.0;

  /// Empty if the pivot is not in front of the eye.
  GizmoLayout(const ViewProjection& view, const GizmoFrame& frame, GizmoMode mode);

  /// In drawing order.
  std::span<const GizmoFigure> figures() const noexcept { return figures_; }
  /// True if the handle is shown.
  bool has(GizmoGrip handle) const noexcept;
  /// The handle that the pointer would grab; None if it is beside all.
  GizmoGrip pick(const glm::dvec2& pixel) const noexcept;

 private:
  /// Arrows that point away from the viewer lie behind the squares.
  enum class Side { Far, Near };
  void addArrow(const ViewProjection& view, const GizmoFrame& frame, int axis, double length);
  void addArrows(const ViewProjection& view, const GizmoFrame& frame, double length, Side side);
  void addPlanes(const ViewProjection& view, const GizmoFrame& frame);
  void addMiddle(const ViewProjection& view, const GizmoFrame& frame);
  /// @param without  Axis without a ring; -1: all have one.
  void addRings(const ViewProjection& view, const GizmoFrame& frame, int without = -1);
  void addViewRing(const ViewProjection& view, const GizmoFrame& frame);

  std::vector<GizmoFigure> figures_;
};

/// Shows how far a drag has come, in pixels.
struct GizmoGuide {
  std::vector<glm::dvec2> line;    ///< The axis across the view; arrows only.
  std::vector<glm::dvec2> way;     ///< From the pivot's start to its position; empty for rings.
  std::vector<glm::dvec2> sector;  ///< Swept by a ring; empty for other handles.
};

/// @param shift  Translation so far, in the world frame [m].
/// @param angle  Rotation so far [rad].
GizmoGuide gizmoGuide(const ViewProjection& view, const GizmoDrag& drag, const glm::dvec3& shift,
                      double angle);

/// Distance of a point from an open polyline [pixels]; infinity if the line is empty.
double distanceToLine(std::span<const glm::dvec2> line, const glm::dvec2& point) noexcept;

/// True if a point is inside a closed polygon, by the even-odd rule.
bool isInside(std::span<const glm::dvec2> polygon, const glm::dvec2& point) noexcept;

/// Corners of the convex hull, in order; fewer than three points are returned as they are. O(n log n).
std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points);

}  // namespace nearfit
