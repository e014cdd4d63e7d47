#include "tests/support/mesh_text.h"

#include <fmt/format.h>

namespace nearfit::test {

std::string objText(const TriangleMesh& mesh) {
  std::string text = "# made by a test\no test\n";
  for (const glm::dvec3& p : mesh.vertices())
    text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  for (const Triangle& t : mesh.triangles())
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

}  // namespace nearfit::test
