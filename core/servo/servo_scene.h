#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/haptics/guidance.h"
#include "core/haptics/mass_metric.h"
#include "core/math/rigid_transform.h"
#include "core/proximity/lmd.h"
#include "core/proximity/surface/unsided_surface.h"
#include "core/scene/joint_set.h"
#include "core/scene/moving_body.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Data that the servo thread needs of a scene. Immutable once shared; made and destroyed off the servo
/// thread. Keeps the geometry alive.
struct ServoScene {
  /// A part as the servo knows it.
  struct Body {
    PartId id{};
    PartGeometryPtr geometry;
    RigidTransform worldFromPart;
    /// Set if the moving part or this one has no inside (is open or has no consistent orientation): contact
    /// then counts from any side. Otherwise null.
    std::shared_ptr<const UnsidedSurface> surface{};
  };
  std::vector<Body> bodies;      ///< Visible parts other than the moving one.
  Body moving;                   ///< The moving part; its geometry is null if there is none.
  glm::dvec3 centreInPart{0.0};  ///< Centre of mass of the moving part, in its frame [m].
  /// Parts that the moving one is made of, if a group is in hand; empty for a part alone. `moving` then has the ID and
  /// the frame of the part that leads, and the geometry of all.
  std::vector<BodyMember> members;
  double mass = 1.0;  ///< Mass of the moving part [kg]; > 0.
  MassMetric metric;  ///< Metric of the moving part.
  JointSet joints;    ///< Joints that keep the moving part; empty if they contradict each other.
  bool areJointsContradictory = false;
  /// Path that the hand is pulled to; null for none. Not part of a Scene: whoever makes this sets it.
  std::shared_ptr<const GuidancePath> guidance;

  /// Sets the moving part and everything that belongs to it except its mass.
  void setMoving(const Body& body);
  /// Sets the joints that keep the moving part.
  void setJoints(const JointSet& set) noexcept;
  /// Sets the surfaces of bodies that have no inside, and of what meets them. To be called last.
  void prepareSurfaces();
  /// True if some contacts are between unsided surfaces.
  bool hasSurfaces() const noexcept { return moving.surface != nullptr; }
  /// The part that a feature of the moving part's searched mesh belongs to: a member of a group, or the part itself.
  /// Real-time safe.
  PartId memberAt(FeatureKind kind, std::uint32_t index) const noexcept;
  /// How much nearer the moving part and a body may be than the meshes that are searched, since their flats
  /// are merged [m]. Real-time safe.
  double deviation(const Body& other) const noexcept;
};

/// The scene for the servo. It has no bodies while the moving part is invisible, so nothing is felt. Builds
/// missing hierarchies, which takes seconds for millions of triangles; prepareHierarchies() does so
/// beforehand, with progress (prepareToFeel() with those of a group in hand). Throws UsageError if the scene has no
/// moving part, or too many joints hold the moving group.
std::unique_ptr<ServoScene> makeServoScene(const Scene& scene);

}  // namespace nearfit
