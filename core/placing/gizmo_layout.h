#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/placing/gizmo.h"
#include "core/placing/view_projection.h"

namespace nearfit {

class GizmoDrag;

/// Of one handle, what is drawn and grabbed: a line or an area of the view, in pixels.
struct GizmoFigure {
  GizmoHandle handle = GizmoHandle::None;
  std::vector<glm::dvec2> points;
  bool isArea = false;     ///< Closed and filled; else an open line.
  double opacity = 1.0;    ///< Less where the view shows too little of it to be of use.
  bool isFarSide = false;  ///< Of a ring, what lies behind the gizmo: cannot be grabbed.
};

/// A gizmo as a view shows it: of the same size on the screen wherever it stands. What is drawn is what can
/// be grabbed, by distances on the screen.
class GizmoLayout {
 public:
  /// All in pixels.
  static constexpr double kArrowLength = 92.0, kLongArrowLength = 112.0;  ///< The longer reach out of rings.
  static constexpr double kRingRadius = 80.0, kViewRingRadius = 98.0;
  static constexpr double kMiddleRadius = 8.0;
  /// How near to a line the pointer must be to grab it.
  static constexpr double kGrabDistance = 7.0;

  /// Nothing is shown where the pivot is not in front of the eye.
  GizmoLayout(const ViewProjection& view, const GizmoFrame& frame, GizmoMode mode);

  /// In the order in which they are to be drawn.
  std::span<const GizmoFigure> figures() const noexcept { return figures_; }
  bool has(GizmoHandle handle) const noexcept;
  /// What the pointer would grab there; None beside all handles.
  GizmoHandle pick(const glm::dvec2& pixel) const noexcept;

 private:
  /// Arrows that point away from the viewer lie behind the squares.
  enum class Side { Far, Near };
  void addArrow(const ViewProjection& view, const GizmoFrame& frame, int axis, double length);
  void addArrows(const ViewProjection& view, const GizmoFrame& frame, double length, Side side);
  void addPlanes(const ViewProjection& view, const GizmoFrame& frame);
  void addMiddle(const ViewProjection& view, const GizmoFrame& frame);
  /// @param without  The axis that has no ring; -1: each has.
  void addRings(const ViewProjection& view, const GizmoFrame& frame, int without = -1);
  void addViewRing(const ViewProjection& view, const GizmoFrame& frame);

  std::vector<GizmoFigure> figures_;
};

/// What shows how far a drag has come, in pixels.
struct GizmoGuide {
  std::vector<glm::dvec2> line;    ///< The axis, through the view; empty but for arrows.
  std::vector<glm::dvec2> way;     ///< From where the pivot stood to where it stands; empty for turns.
  std::vector<glm::dvec2> sector;  ///< That a ring has swept; empty for shifts.
};

/// @param shift  Where the drag has come to, in the world [m].   @param angle  Turned by so much [rad].
GizmoGuide gizmoGuide(const ViewProjection& view, const GizmoDrag& drag, const glm::dvec3& shift,
                      double angle);

}  // namespace nearfit
