#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/report/mesh_export.h"

namespace nearfit {

/// Kinds of files that a scene can be exported to.
enum class ExportKind : std::uint8_t {
  PlacementJson,  ///< placement_export.h
  PlacementCsv,   ///< placement_table.h
  MeshStl,        ///< mesh_export.h
  MeshObj,
  MeshPly,
  ClearanceMapPly,        ///< clearance_map_export.h
  ClearanceHistogramCsv,  ///< clearance_histogram.h
};

/// File name extension: "json", "csv", "stl", "obj" or "ply".
std::string_view extensionOf(ExportKind kind) noexcept;
/// The kind that a file's extension stands for, in any case; std::nullopt if none. Never a map or its histogram: other
/// kinds have the same extensions.
std::optional<ExportKind> exportKindOf(const std::filesystem::path& file);
/// The kind of mesh file; std::nullopt for placements and maps.
std::optional<MeshFileKind> meshKindOf(ExportKind kind) noexcept;

/// The map of clearance to export.
struct MapExport {
  std::vector<PartId> subject;  ///< Parts that are mapped as one; empty: what is in hand.
  double range = 0.0;           ///< [m]; 0: automatic.
  bool hasNearParts = false;    ///< Surfaces of near parts too.
};

/// What to export.
struct SceneExport {
  ExportKind kind = ExportKind::PlacementJson;
  double metresPerUnit = 1e-3;  ///< Unit of a mesh file's numbers [m]; placements are in metres.
  std::vector<PartId> only;     ///< Parts of a mesh; empty: all visible ones. Placements have all parts.
  MapExport map;                ///< For a map of clearance or its histogram.
};

/// Exports a scene to a file, atomically. Blocking: a JSON placement and a map build missing hierarchies.
/// @param worldFromMoving  Present pose of the moving part; unused if there is none.
/// Throws FileError, UsageError, Cancelled (meshes, maps).
void exportScene(const Scene& scene, const RigidTransform& worldFromMoving, const SceneExport& what,
                 const std::filesystem::path& file, const ProgressCallback& progress = {});

}  // namespace nearfit
