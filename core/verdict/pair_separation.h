#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/overlap/interference.h"
#include "core/proximity/query/lmd_query.h"
#include "core/scene/pair_record.h"
#include "core/scene/part_geometry.h"

namespace nearfit {

class ComponentsOnDemand;

/// Gap or depth up to which bodies count as touching [m]: what rounding in files and poses comes to. A millionth
/// of the smaller one's diagonal, at most 1 um.
double touchTolerance(const PartGeometry& a, const PartGeometry& b) noexcept;

/// How two bodies are to each other, in the frame of the other's mesh.
struct PairSeparation {
  /// Exact (interference.h); its `scene` is the other body. Bodies that touch meet too.
  InterferenceKind overlap = InterferenceKind::Disjoint;
  /// True if they are apart by at most touchTolerance(), or meet and are separated by a motion of that
  /// (touching_bodies.h).
  bool isTouching = false;
  double distance = 0.0;  ///< Min distance between the surfaces [m]; 0 if the bodies overlap or touch.
  /// Nearest points of the surfaces [m]; on the surfaces even if one body is inside the other.
  glm::dvec3 partPoint{0.0}, otherPoint{0.0};
};

/// Finds how two bodies are to each other; builds missing hierarchies.
/// @param otherFromPart  Unit quaternion. Throws UsageError if it is not finite.
/// @param within         Max distance of interest [m]; > 0, may be infinite.
/// @param scratch        Work space, one per thread.
/// No value if the surfaces are farther apart and neither body is inside the other. Milliseconds; allocates.
std::optional<PairSeparation> separationOf(const PartGeometry& part, const PartGeometry& other,
                                           const RigidTransform& otherFromPart, double within,
                                           LmdScratch& scratch);

/// Components of two bodies (containment.h), kept for further calls.
struct PairComponents {
  ComponentsOnDemand &part, &other;
};
/// The same with components that are kept: those of a body are found once, in time proportional to its triangles.
std::optional<PairSeparation> separationOf(const PartGeometry& part, const PartGeometry& other,
                                           const RigidTransform& otherFromPart, double within,
                                           LmdScratch& scratch, const PairComponents& components);

/// The distance that separationOf() finds, and no value where that finds none, without what else it finds: of bodies
/// that meet, whose surfaces are hard to tell apart, in a small part of the time.
std::optional<double> distanceWithin(const PartGeometry& part, const PartGeometry& other,
                                     const RigidTransform& otherFromPart, double within, LmdScratch& scratch,
                                     const PairComponents& components);

/// The verdict on two bodies within the threshold: never Clear.
PairVerdict verdictOf(const PairSeparation& separation) noexcept;

}  // namespace nearfit
