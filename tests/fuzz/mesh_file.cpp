// Importers: the first byte says what the file's name ends in, the rest is the file. Whatever it holds, there
// is a mesh that all that follows can work with, or an Error.
#include <array>
#include <cmath>
#include <span>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/mesh/mass_properties.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/surface/unsided_surface.h"
#include "tests/fuzz/fuzz_target.h"

namespace nearfit::fuzz {
namespace {

void check(const ImportedMesh& imported) {
  const TriangleMesh& mesh = imported.mesh;
  require(!mesh.triangles().empty(), "what is imported has triangles");
  for (const glm::dvec3& v : mesh.vertices())
    require(isFinite(v), "vertices are finite");
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t corner : t)
      require(corner < mesh.vertices().size(), "corners are vertices");
    require(t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "corners differ");
  }
  const MassProperties mass = massProperties(mesh);
  require(std::isfinite(mass.volume) && isFinite(mass.centre), "mass properties are finite");
  for (int k = 0; k < 3; ++k)
    require(isFinite(mass.inertia[k]), "mass properties are finite");
  const NormalConeTree tree(mesh);
  const UnsidedSurface surface(tree);
  require(surface.mesh().triangles().size() == mesh.triangles().size(), "the surface is that of the mesh");
}

void run(std::span<const std::uint8_t> data) {
  constexpr std::array kNames{"part.stl", "part.obj", "part.ply", "part.off", "part"};
  if (data.empty()) return;
  const std::uint8_t choice = data[0];
  const std::vector<char> bytes(data.begin() + 1, data.end());
  MeshBuildOptions options;
  options.metresPerUnit = (choice & 0x80U) != 0 ? 1.0 : 0.001;
  requireReadOrRefused<Error>(
      [&] { check(importMeshBytes(kNames[choice % kNames.size()], bytes, options)); });
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run({data, size});
  return 0;
}
