#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "core/math/rigid_transform.h"
#include "core/placing/gizmo.h"
#include "core/placing/view_projection.h"

namespace nearfit {

/// Step sizes that a drag snaps to.
struct SnapSteps {
  double length = 0.0;  ///< Translation along the gizmo's axes, from the drag's start [m]; 0: no snapping.
  double angle = 0.0;   ///< Rotation [rad]; 0: no snapping.
};

/// One drag of a gizmo handle: converts the pointer's way over the view to a motion.
///
/// The grabbed point stays under the pointer where the handle allows it. If the view shows the handle's axis
/// end on or its plane edge on, the pointer determines only part of the motion; the rest stays unchanged,
/// without jumps. A pointer beyond the horizon of an axis or plane moves it only up to the horizon.
class GizmoDrag {
 public:
  /// @param grabbed  For MoveFree: the point that stays under the pointer; default: the pivot.
  GizmoDrag(const ViewProjection& view, const GizmoFrame& frame, GizmoGrip handle, const glm::dvec2& pixel,
            const std::optional<glm::dvec3>& grabbed = std::nullopt);

  /// Moves the pointer to a pixel; non-finite pixels are ignored. Rotation accumulates over any
  /// number of turns.
  void moveTo(const ViewProjection& view, const glm::dvec2& pixel);

  /// Sets an amount in place of the pointer's: along an arrow [m], about a ring's axis [rad], for other handles along
  /// the pointer's way [m]. It does not snap. std::nullopt: the pointer decides again.
  void setAmount(const std::optional<double>& amount) noexcept { amount_ = amount; }

  GizmoGrip handle() const noexcept { return handle_; }
  /// The gizmo's pose when the drag began.
  const GizmoFrame& frame() const noexcept { return frame_; }

  /// Translation so far, in the world frame [m]; zero for rings.
  glm::dvec3 shift(const SnapSteps& steps = {}) const noexcept;
  /// Rotation so far about turnAxis(), anticlockwise seen from its tip [rad]; 0 for other handles.
  double angle(const SnapSteps& steps = {}) const noexcept;
  /// Unit, in the world frame.
  const glm::dvec3& turnAxis() const noexcept { return axis_; }
  /// For rings: direction from the pivot to where it was grabbed; unit, perpendicular to the axis.
  const glm::dvec3& grabbedArm() const noexcept { return grabbedArm_; }
  /// The pivot's translation in `motion`, which may deviate from the drag, such as at contact
  /// [m]; zero for rings.
  glm::dvec3 shiftIn(const RigidTransform& motion) const noexcept;
  /// The angle of `motion` about turnAxis(), in the turn nearest to the wanted one [rad]; 0 for other handles.
  double angleIn(const RigidTransform& motion) const noexcept;
  /// Motion of what is dragged: a world point p moves from its start to motion(p).
  RigidTransform motion(const SnapSteps& steps = {}) const noexcept;

 private:
  std::optional<double> alongAxis(const ViewProjection& view, const glm::dvec2& pixel) const noexcept;
  std::optional<glm::dvec3> onPlane(const ViewProjection& view, const glm::dvec2& pixel) const noexcept;
  glm::dvec3 acrossView(const ViewProjection& view, const glm::dvec2& pixel) const noexcept;
  std::optional<double> angleAt(const ViewProjection& view, const glm::dvec2& pixel) const noexcept;
  void grabRingOnEdge(const ViewProjection& view) noexcept;
  void follow(const ViewProjection& view, const glm::dvec2& pixel) noexcept;

  GizmoFrame frame_;
  GizmoGrip handle_;
  std::optional<double> amount_;
  glm::dvec3 axis_;    ///< Along an arrow, normal of a plane, or axis of rotation; unit.
  glm::dvec3 anchor_;  ///< A point on the axis or plane.
  bool isOnEdge_ = false;
  glm::dvec2 pressed_;
  double alongAtStart_ = 0.0, along_ = 0.0;
  glm::dvec3 onPlaneAtStart_{0.0}, onPlane_{0.0};
  glm::dvec3 grabbedArm_{1.0, 0.0, 0.0};
  double lastAngle_ = 0.0, turned_ = 0.0;
  glm::dvec2 tangent_{0.0};  ///< For a ring edge on: rotation per pointer motion [rad/pixel].
};

}  // namespace nearfit
