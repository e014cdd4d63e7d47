#pragma once

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit::bench {

/// One ellipse of a swept tube; `u` and `v` are its half axes, u x v points along the sweep.
struct SweptRing {
  glm::dvec3 centre, u, v;
};

/// A tube through rings of `around` corners each, closed at both ends by fans about the end rings' centres.
/// 2 * around * rings faces. @param rings  At least two.
TriangleMesh sweptMesh(std::span<const SweptRing> rings, std::uint32_t around);

}  // namespace nearfit::bench
