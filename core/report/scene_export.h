#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/report/mesh_export.h"

namespace nearfit {

/// What can be taken away of a scene.
enum class ExportKind : std::uint8_t {
  PlacementJson,  ///< placement_export.h
  PlacementCsv,   ///< placement_table.h
  MeshStl,        ///< mesh_export.h
  MeshObj,
  MeshPly,
};

/// What a file of that kind ends in: "json", "csv", "stl", "obj" or "ply".
std::string_view extensionOf(ExportKind kind) noexcept;
/// The kind that a file's name tells; nothing where it tells none.
std::optional<ExportKind> exportKindOf(const std::filesystem::path& file);
/// The kind of mesh; nothing for placements.
std::optional<MeshFileKind> meshKindOf(ExportKind kind) noexcept;

struct SceneExport {
  ExportKind kind = ExportKind::PlacementJson;
  double metresPerUnit = 1e-3;  ///< Of a mesh file's numbers; placements are in metres.
  std::vector<PartId> only;     ///< Parts of a mesh; empty: all visible ones. Placements have all parts.
};

/// Writes it atomically. Blocking: builds hierarchies that a placement with clearances needs.
/// @param worldFromMoving  Where the moving part is; unused when there is none.
/// Throws FileError, UsageError, Cancelled (meshes).
void exportScene(const Scene& scene, const RigidTransform& worldFromMoving, const SceneExport& what,
                 const std::filesystem::path& file, const ProgressCallback& progress = {});

}  // namespace nearfit
