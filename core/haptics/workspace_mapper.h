#pragma once

#include "core/haptics/device_limits.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// Turns motion of the device into motion of the handle in the scene. The handle's pose is its pose at the
/// last *index* plus the device's motion since, rotated by the offset, scaled and without what is locked:
///
///     translation  t = t0 + lock(s O (d - d0))        rotation  R = lock(O (D D0^-1) O^-1) R0
///
/// with d, D the device's position and rotation, O the offset, s the scale and t the position of the pivot.
/// Engaging sets an index. So do the clutch and every change of the mapping, without moving the handle.
///
/// Along locked world axes the handle stays where the index has it. Of the rotation since the index, with two
/// axes locked only the twist about the third counts, through any number of revolutions. With one axis
/// locked, the twist about it is left out, and the rest is a rotation about an axis perpendicular to it. Near
/// half a turn such a twist is not defined, so the mapper sets a new index past a quarter turn. Rotations do
/// not commute: over two axes, larger tilts in a loop can bring the handle back slightly rotated, even about
/// the locked axis.
///
/// Real-time safe throughout.
class WorkspaceMapper {
 public:
  /// For devices whose poses are world poses: the handle starts at the device's pose.
  void engage(const RigidTransform& device) noexcept { engageAt(device, device); }

  /// For devices with a frame of their own: the handle starts at the part, wherever the device is.
  /// @param device         Pose of the device, in its own frame.
  /// @param worldFromPart  Pose of the handle at the start.
  /// @param pivotInPart    Point of the part that the device's origin stands for, in the part's frame [m]:
  ///                       the device's rotations turn the part about it. Usually the centre of mass: a part
  ///                       whose own origin is far away would swing, and force on that lever would act as
  ///                       stiffness against rotation.
  void engageAt(const RigidTransform& device, const RigidTransform& worldFromPart,
                const glm::dvec3& pivotInPart = glm::dvec3(0.0)) noexcept;

  /// Pose of the handle, worldFromPart. With a mapping that changes nothing (scale 1, no offset, no locks)
  /// and no clutch since engage(), it is the device's pose bit for bit. Without engaging, the first call
  /// engages at the device's pose.
  ///
  /// @param device      As measured, in its own frame; unit quaternion.
  /// @param isClutched  The handle stays; after release it goes on from there.
  /// @param mapping     Scale > 0, unit offset.
  /// A device pose that is not finite is returned unchanged, for the caller to see, and has no other effect.
  RigidTransform map(const RigidTransform& device, bool isClutched, const WorkspaceMapping& mapping) noexcept;

 private:
  void setIndex(const RigidTransform& device, const RigidTransform& handle) noexcept;
  RigidTransform sinceIndex(const RigidTransform& device, bool& isFarTurned) const noexcept;

  bool isEngaged_ = false;
  bool hasMapping_ = false;  ///< `mapping_` is from a call since engaging.
  bool isDirect_ = false;    ///< Handle and device coincided at the index.
  WorkspaceMapping mapping_;
  glm::dvec3 pivot_{0.0};  ///< In the part's frame [m].
  RigidTransform indexDevice_, indexHandle_;
  RigidTransform lastDevice_, lastHandle_;
};

/// The device as it appears at the handle, through a mapping of scale s. The device moves by 1/s of the
/// handle's motion and renders the force unchanged and the torque over s (wrenchOnDevice()). So its energies
/// are those at the handle over s, and what is passive at the handle is passive at the device. Damping and
/// mass against translation are 1/s of the device's; damping and inertia against rotation, and the limits of
/// torque, are s times the device's. Use these for coupling, passivity and limits. A scale that is not finite
/// or <= 0 counts as 1. Real-time safe.
DeviceLimits limitsAtHandle(const DeviceLimits& device, double scale) noexcept;

/// A wrench on the handle as the device is to render it, in the device's frame. Components along locked axes
/// are left out: the device moves along them while the handle does not, and would be pushed for ever. The
/// torque is divided by the scale (see limitsAtHandle()). Finally the wrench is rotated back by the offset.
/// Torque stays about the centre of mass: a device that turns about another point must add the force's moment
/// about it. Real-time safe.
Wrench wrenchOnDevice(const Wrench& wrench, const WorkspaceMapping& mapping) noexcept;

}  // namespace nearfit
