#pragma once

#include "core/placing/feature_pick.h"

namespace nearfit::test {

/// Where a ray hits a mesh first: each triangle by its plane and sides. A test fails where nothing is hit.
SurfaceHit hitBy(const TriangleMesh& mesh, const glm::dvec3& from, const glm::dvec3& towards);

}  // namespace nearfit::test
