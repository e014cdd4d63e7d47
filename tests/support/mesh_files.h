#pragma once

#include <string>

#include "core/mesh/mesh_builder.h"
#include "core/mesh/triangle_mesh.h"
#include "tests/support/mesh_text.h"

/// Meshes as the bytes of a file, in metres; as an OBJ file: objText.
namespace nearfit::test {

std::string stlBinary(const TriangleMesh& mesh, const std::string& header = "written by a test");
std::string stlText(const TriangleMesh& mesh);
std::string offText(const TriangleMesh& mesh);
std::string plyText(const TriangleMesh& mesh);
enum class ByteOrder { Little, Big };
/// Coordinates are doubles, list counts uchar, indices int.
std::string plyBinary(const TriangleMesh& mesh, ByteOrder order = ByteOrder::Little);

/// The triangles as polygons of a soup.
PolygonSoup soupOf(const TriangleMesh& mesh);

}  // namespace nearfit::test
