#pragma once

#include <string>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// SHA-256 of a mesh's geometry: coordinates of its vertices and indices of its triangles, as bits.
std::string meshSha256(const TriangleMesh& mesh);

}  // namespace nearfit
