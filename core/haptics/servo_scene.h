#pragma once

#include <memory>
#include <vector>

#include "core/haptics/mass_metric.h"
#include "core/math/rigid_transform.h"
#include "core/proximity/unsided_surface.h"
#include "core/scene/scene.h"

namespace nearfit {

/// What the servo thread needs of a scene: immutable, made off the servo thread, shared with no one who
/// writes. Holds the geometry alive; must be destroyed off the servo thread.
struct ServoScene {
  struct Body {
    PartId id{};
    PartGeometryPtr geometry;
    RigidTransform worldFromPart;
    /// Where the part in hand or this one has no inside (open, or of no orientation): it is then kept out
    /// whatever side it is seen from. Else null.
    std::shared_ptr<const UnsidedSurface> surface{};
  };
  std::vector<Body> bodies;      ///< Visible parts other than the moving one.
  Body moving;                   ///< geometry is null when nothing is in hand.
  glm::dvec3 centreInPart{0.0};  ///< Centre of mass of the moving part, in its frame [m].
  double mass = 1.0;             ///< Of the moving part [kg]; > 0.
  MassMetric metric;             ///< Of the moving part.

  /// Puts a part in hand, with what belongs to it but for its mass.
  void setMoving(const Body& body);
  /// Gives bodies that have no inside, and what meets them, their surfaces. Called last.
  void prepareSurfaces();
  bool hasSurfaces() const noexcept { return moving.surface != nullptr; }
};

/// Nothing is felt while the moving part is invisible. Builds the hierarchies that are missing, which takes
/// seconds for millions of triangles: prepareHierarchies() does so with progress before. Throws UsageError
/// when the scene has no moving part.
std::unique_ptr<const ServoScene> makeServoScene(const Scene& scene);

}  // namespace nearfit
