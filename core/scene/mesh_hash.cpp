#include "core/scene/mesh_hash.h"

#include <span>

#include <fmt/format.h>

#include "core/files/sha256.h"

namespace nearfit {

std::string meshSha256(const TriangleMesh& mesh) {
  const auto hashOf = [](const auto& values) {
    const auto bytes = std::as_bytes(values);
    return sha256OfBytes({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  return sha256OfBytes(fmt::format("mesh 1 {} {} {} {}", mesh.vertices().size(), hashOf(mesh.vertices()),
                                   mesh.triangles().size(), hashOf(mesh.triangles())));
}

}  // namespace nearfit
