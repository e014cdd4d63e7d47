#pragma once

#include "core/haptics/device_limits.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// Turns motion of the device into motion of the handle in the scene. The handle's pose is that at the last
/// *index* plus what the device has moved since, turned by the offset, scaled and freed of what is locked:
///
///     translation  t = t0 + lock(s O (d - d0))        rotation  R = lock(O (D D0^-1) O^-1) R0
///
/// with d, D the device's pose, O the offset, t the place of the pivot. Engaging sets an index. So do,
/// without moving the handle, the clutch and every change of the mapping.
///
/// Locked world axes: the handle stays where the index has it along them. Of the turn since the index, with
/// two axes locked only the twist about the third counts, through any number of revolutions; with one locked,
/// its twist about that axis is left out, and what remains is a turn about an axis square to it. Near half a
/// turn away such a twist is not defined, so past a quarter turn the mapper sets an index. Turns do not
/// commute: over two axes, tilts of more than that in a loop can bring the handle back turned a little, even
/// about the locked axis.
///
/// Real-time safe throughout.
class WorkspaceMapper {
 public:
  /// For devices whose poses are poses in the world: the handle begins at the device's pose itself.
  void engage(const RigidTransform& device) noexcept { engageAt(device, device); }

  /// For devices with a frame of their own: the handle begins at the part, wherever the device is.
  /// @param pivotInPart  What the device's origin stands for [m]: turns of the device turn the part about it.
  ///                     The centre of mass, as a rule: a part whose own origin is far off would else swing,
  ///                     and force on that lever would count as stiffness against turning.
  void engageAt(const RigidTransform& device, const RigidTransform& worldFromPart,
                const glm::dvec3& pivotInPart = glm::dvec3(0.0)) noexcept;

  /// The handle's pose. After `engage`, with a mapping that changes nothing (scale 1, no offset, no locks)
  /// and no clutch so far, it is the device's pose bit for bit. Without engaging, the first call does, at
  /// the device's pose.
  ///
  /// @param device      As measured, in its own frame; unit quaternion.
  /// @param isClutched  The handle stays, and goes on from there with the motion after release.
  /// @param mapping     Scale > 0, unit offset.
  /// A device pose that is not finite is returned as it is, for the caller to see, and leaves no trace.
  RigidTransform map(const RigidTransform& device, bool isClutched, const WorkspaceMapping& mapping) noexcept;

 private:
  void setIndex(const RigidTransform& device, const RigidTransform& handle) noexcept;
  RigidTransform sinceIndex(const RigidTransform& device, bool& isFarTurned) const noexcept;

  bool isEngaged_ = false;
  bool hasMapping_ = false;  ///< `mapping_` is from a call since engaging.
  bool isDirect_ = false;    ///< Handle and device were one at the index.
  WorkspaceMapping mapping_;
  glm::dvec3 pivot_{0.0};  ///< In the part's frame.
  RigidTransform indexDevice_, indexHandle_;
  RigidTransform lastDevice_, lastHandle_;
};

/// The device as it appears at the handle, over a mapping of scale s: the device moves by 1/s of the handle
/// and renders force as it is and torque over s (wrenchOnDevice), so that all energies are those at the
/// handle over s, and what is passive at the handle is so at the device. Its damping and mass against shifts
/// are 1/s of the device's, those against turns, and the limits of torque, s times. Coupling, passivity and
/// limits are to be reckoned with these. A scale that is not finite or <= 0 counts as 1. Real-time safe.
DeviceLimits limitsAtHandle(const DeviceLimits& device, double scale) noexcept;

/// A wrench on the handle as the device is to render it, in the device's frame: what points along locked axes
/// is left out (the device moves along them while the handle does not, and would be pushed for ever), the
/// torque is divided by the scale (limitsAtHandle says why), all is turned back by the offset. Torque stays
/// about the centre of mass: a device that turns about another point has to add the force's moment about it.
/// Real-time safe.
Wrench wrenchOnDevice(const Wrench& wrench, const WorkspaceMapping& mapping) noexcept;

}  // namespace nearfit
