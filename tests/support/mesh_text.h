#pragma once

#include <string>

#include "core/mesh/triangle_mesh.h"

namespace nearfit::test {

/// The mesh as a Wavefront OBJ file, its coordinates exact.
std::string objText(const TriangleMesh& mesh);

}  // namespace nearfit::test
