#pragma once

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"
#include "core/placing/align.h"
#include "core/placing/feature.h"

namespace nearfit {

/// The feature that a part is inserted by, in the mesh's frame. A round edge with a flat face in its plane becomes a
/// circle along the outward normal of that face. Of anything else round only the axis counts. O(n) in the edge.
/// @param picked  A circle or the axis of a cylinder of `mesh`.
AlignFeature insertFeature(const TriangleMesh& mesh, const PickedFeature& picked);

/// True if insertMotion() brings faces together: both features are circles.
bool canBeSeated(FeatureShape moving, FeatureShape fixed) noexcept;

/// The motion that inserts a part by one feature into another one, both in the world frame and by insertFeature().
///
/// Two circles: the axes become one, and the faces at the edges lie flush and look at each other; with options they
/// look the same way, or a distance is left between them. Otherwise the axes become one by the smallest motion, as
/// alignMotion() does.
/// @return worldFromWorld: the part's new pose is this times its present one.
RigidTransform insertMotion(const AlignFeature& moving, const AlignFeature& fixed,
                            const AlignOptions& options = {});

}  // namespace nearfit
