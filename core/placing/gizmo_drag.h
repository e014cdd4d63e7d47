#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "core/math/rigid_transform.h"
#include "core/placing/gizmo.h"
#include "core/placing/view_projection.h"

namespace nearfit {

/// In what steps a drag goes.
struct SnapSteps {
  double length = 0.0;  ///< Of shifts, along the gizmo's axes, from where the drag began [m]; 0: none.
  double angle = 0.0;   ///< Of turns [rad]; 0: none.
};

/// One drag of a handle, from the pointer's way over the view to the motion that it asks for.
///
/// What was grabbed stays under the pointer where the handle allows. Where the view shows a handle's axis end
/// on, or its plane on edge, the pointer says little of the motion: it then moves what it can say, and never
/// by a jump. Pointers beyond the horizon of an axis or plane move it no farther than to there.
class GizmoDrag {
 public:
  /// @param grabbed  For MoveFree, the point that is to stay under the pointer; the pivot where there is
  /// none.
  GizmoDrag(const ViewProjection& view, const GizmoFrame& frame, GizmoHandle handle, const glm::dvec2& pixel,
            const std::optional<glm::dvec3>& grabbed = std::nullopt);

  /// The pointer is there now. Turns add up over any number of rounds.
  void moveTo(const ViewProjection& view, const glm::dvec2& pixel);

  GizmoHandle handle() const noexcept { return handle_; }
  /// As the gizmo stood when the drag began.
  const GizmoFrame& frame() const noexcept { return frame_; }

  /// Where the drag has come to, in the world [m]; zero for turns.
  glm::dvec3 shift(const SnapSteps& steps = {}) const noexcept;
  /// About turnAxis(), anticlockwise seen from its tip [rad]; zero for shifts.
  double angle(const SnapSteps& steps = {}) const noexcept;
  /// Unit, in the world.
  const glm::dvec3& turnAxis() const noexcept { return axis_; }
  /// Of a ring, the direction from the pivot in which it was grabbed; unit, across the axis.
  const glm::dvec3& grabbedArm() const noexcept { return grabbedArm_; }
  /// What of the drag a motion is that has come less far, or aside: the pivot's shift in the world [m]...
  glm::dvec3 shiftIn(const RigidTransform& motion) const noexcept;
  /// ... and the turn about turnAxis(), in the round that is nearest to the pointer's [rad].
  double angleIn(const RigidTransform& motion) const noexcept;
  /// Of all that is dragged: what stood at a point p of the world then shall stand at motion(p).
  RigidTransform motion(const SnapSteps& steps = {}) const noexcept;

 private:
  std::optional<double> alongAxis(const ViewProjection& view, const glm::dvec2& pixel) const noexcept;
  std::optional<glm::dvec3> onPlane(const ViewProjection& view, const glm::dvec2& pixel) const noexcept;
  glm::dvec3 acrossView(const ViewProjection& view, const glm::dvec2& pixel) const noexcept;
  std::optional<double> angleAt(const ViewProjection& view, const glm::dvec2& pixel) const noexcept;
  void grabRingOnEdge(const ViewProjection& view) noexcept;
  void follow(const ViewProjection& view, const glm::dvec2& pixel) noexcept;

  GizmoFrame frame_;
  GizmoHandle handle_;
  glm::dvec3 axis_;    ///< Of an arrow, across a plane, or that is turned about; unit.
  glm::dvec3 anchor_;  ///< Point that axis and plane go through.
  bool isOnEdge_ = false;
  glm::dvec2 pressed_;
  double alongAtStart_ = 0.0, along_ = 0.0;
  glm::dvec3 onPlaneAtStart_{0.0}, onPlane_{0.0};
  glm::dvec3 grabbedArm_{1.0, 0.0, 0.0};
  double lastAngle_ = 0.0, turned_ = 0.0;
  glm::dvec2 tangent_{0.0};  ///< Of a ring on edge: radians for a way of the pointer [rad/pixel].
};

}  // namespace nearfit
