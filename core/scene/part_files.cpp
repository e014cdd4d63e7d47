#include "core/scene/part_files.h"

#include "core/scene/part_geometry.h"

namespace nearfit {

std::vector<std::filesystem::path> partFiles(const Scene& scene) {
  std::vector<std::filesystem::path> files;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (!part->geometry || part->geometry->file.empty()) continue;
    files.push_back(part->geometry->file);
    if (!part->geometry->companions) continue;
    for (const CompanionFile& companion : *part->geometry->companions)
      files.push_back(companion.file);
  }
  return files;
}

}  // namespace nearfit
