#include "tests/bench/scene_files.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/scene/part_geometry.h"
#include "core/scene/scene_file.h"
#include "tests/support/mesh_text.h"
#include "tests/support/part_geometries.h"

namespace nearfit::bench {

Scene sceneOf(const ManyPartsScene& many) {
  std::vector<PartGeometryPtr> geometries;
  for (const TriangleMesh& mesh : many.meshes)
    geometries.push_back(test::freshGeometryOf(mesh));
  Scene scene;
  for (const ManyPartsPlace& place : many.parts)
    scene.add(test::partOf(geometries[place.mesh], fmt::format("part {}", scene.parts().size() + 1).c_str(),
                           place.worldFromPart));
  return scene;
}

std::filesystem::path writeWithMeshes(const Scene& scene, const test::TemporaryFolder& folder) {
  std::map<const PartGeometry*, PartGeometryPtr> written;
  Scene ofFiles = scene;
  for (const Scene::PartPtr& part : scene.parts()) {
    PartGeometryPtr& geometry = written[part->geometry.get()];
    if (!geometry) {
      const std::string name = fmt::format("mesh_{}.obj", written.size());
      geometry = loadPartGeometry(folder.write(name, test::objText(part->geometry->mesh)), 1.0);
    }
    Part filed = *part;
    filed.geometry = geometry;
    ofFiles.replace(std::move(filed));
  }
  const std::filesystem::path file = folder.path() / "scene.nearfit";
  writeSceneFile(ofFiles, file);
  return file;
}

}  // namespace nearfit::bench
