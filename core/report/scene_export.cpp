#include "core/report/scene_export.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "core/files/atomic_write.h"
#include "core/report/placement_export.h"
#include "core/report/placement_table.h"

namespace nearfit {
namespace {

constexpr std::array kKinds = {ExportKind::PlacementJson, ExportKind::PlacementCsv, ExportKind::MeshStl,
                               ExportKind::MeshObj, ExportKind::MeshPly};

}  // namespace

std::optional<MeshFileKind> meshKindOf(ExportKind kind) noexcept {
  switch (kind) {
    case ExportKind::MeshStl:
      return MeshFileKind::StlBinary;
    case ExportKind::MeshObj:
      return MeshFileKind::Obj;
    case ExportKind::MeshPly:
      return MeshFileKind::Ply;
    case ExportKind::PlacementJson:
    case ExportKind::PlacementCsv:
      break;
  }
  return std::nullopt;
}

std::string_view extensionOf(ExportKind kind) noexcept {
  if (const auto mesh = meshKindOf(kind)) return extensionOf(*mesh);
  return kind == ExportKind::PlacementJson ? "json" : "csv";
}

std::optional<ExportKind> exportKindOf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const ExportKind kind : kKinds) {
    if (extension == extensionOf(kind)) return kind;
  }
  return std::nullopt;
}

void exportScene(const Scene& scene, const RigidTransform& worldFromMoving, const SceneExport& what,
                 const std::filesystem::path& file, const ProgressCallback& progress) {
  if (const auto mesh = meshKindOf(what.kind)) {
    const Scene placed = placedScene(scene, worldFromMoving);
    exportMesh(chosenParts(placed, what.only), *mesh, what.metresPerUnit, file, progress);
  } else if (what.kind == ExportKind::PlacementCsv) {
    atomicWrite(file, placementCsv(scene, worldFromMoving));
  } else {
    exportPlacement(scene, worldFromMoving, file);
  }
}

}  // namespace nearfit
