#include "core/report/scene_mesh_files.h"

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/report/mesh_export.h"
#include "core/scene/built_geometry.h"
#include "core/scene/mesh_hash.h"

namespace nearfit {
namespace {

/// Digits of a hash that name a file: 64 bits, so that two meshes of a scene never share one.
constexpr std::size_t kMeshNameDigits = 16;

PartGeometryPtr writtenTo(const std::filesystem::path& folder, const PartGeometryPtr& geometry) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    throw FileError(folder.string(), "the folder cannot be created: " + failure.message(),
                    "choose another place");
  const std::filesystem::path file =
      folder / (meshSha256(geometry->mesh).substr(0, kMeshNameDigits) + ".ply");
  Part part;
  part.name = "Mesh";
  part.geometry = geometry;
  const Scene::PartPtr parts[] = {std::make_shared<const Part>(std::move(part))};
  exportMesh(parts, MeshFileKind::Ply, 1.0, file);
  return namedGeometry(*geometry, file);
}

}  // namespace

Scene withMeshFiles(const Scene& scene, const std::filesystem::path& sceneFile) {
  const std::filesystem::path folder = sceneFile.parent_path() / (sceneFile.stem().string() + "_meshes");
  Scene saved = scene;
  std::map<PartGeometryPtr, PartGeometryPtr> written;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (!part->geometry || !part->geometry->file.empty()) continue;
    PartGeometryPtr& named = written[part->geometry];
    if (!named) named = writtenTo(folder, part->geometry);
    Part changed = *part;
    changed.geometry = named;
    saved.replace(std::move(changed));
  }
  return saved;
}

}  // namespace nearfit
