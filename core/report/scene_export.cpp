#include "core/report/scene_export.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/report/clearance_histogram.h"
#include "core/report/clearance_map.h"
#include "core/report/clearance_map_export.h"
#include "core/report/glb_export.h"
#include "core/report/placement_export.h"
#include "core/report/placement_table.h"
#include "core/report/step_export.h"
#include "core/report/threemf_export.h"
#include "core/report/urdf_export.h"

namespace nearfit {
namespace {

/// Kinds that an extension stands for.
constexpr std::array kKinds = {
    ExportKind::PlacementJson,   ExportKind::PlacementCsv, ExportKind::MeshStl,
    ExportKind::MeshObj,         ExportKind::MeshPly,      ExportKind::AssemblyGlb,
    ExportKind::AssemblyThreeMf, ExportKind::AssemblyUrdf, ExportKind::AssemblyStep};
/// Another extension of STEP files.
constexpr std::string_view kShortStep = "stp";

/// Progress when a map is computed.
constexpr double kMapped = 0.8;

bool isMap(ExportKind kind) noexcept {
  return kind == ExportKind::ClearanceMapPly || kind == ExportKind::ClearanceHistogramCsv;
}

/// @param placed  Has the moving part where it is now.
void exportMap(const Scene& placed, const SceneExport& what, const std::filesystem::path& file,
               const ProgressCallback& progress) {
  const std::vector<PartId> subject = what.map.subject.empty() ? placed.movingParts() : what.map.subject;
  if (subject.empty())
    throw UsageError("clearance map", "no part is selected or in hand", "select the part to map");
  const ClearanceMap map =
      ClearanceMapper().map(clearanceMapRequest(placed, subject, what.map.range, what.map.hasNearParts),
                            stageCallback(progress, 0.0, kMapped));
  if (what.kind == ExportKind::ClearanceMapPly) {
    exportClearanceMap(map, placed, what.metresPerUnit, file, stageCallback(progress, kMapped, 1.0));
  } else {
    atomicWrite(file, histogramCsv(AreaByClearance(map.subject()), map.range));
  }
}

/// @param placed  Has the moving part where it is now.
std::vector<std::string> exportAssembly(const Scene& placed, const SceneExport& what,
                                        const std::filesystem::path& file, const ProgressCallback& progress) {
  const std::vector<Scene::PartPtr> parts = chosenParts(placed, what.only);
  if (what.kind == ExportKind::AssemblyStep)
    return exportStep(placed, parts, what.schema, file, progress).notes;
  if (what.kind == ExportKind::AssemblyGlb) {
    exportGlb(placed, parts, file, progress);
  } else if (what.kind == ExportKind::AssemblyThreeMf) {
    exportThreeMf(placed, parts, what.metresPerUnit, file, progress);
  } else {
    exportUrdf(placed, parts, file, progress);
  }
  return {};
}

}  // namespace

ExportKind knownExportKindOf(const std::filesystem::path& file) {
  if (const auto kind = exportKindOf(file)) return *kind;
  throw UsageError(file.string(), "its suffix is not that of a known format",
                   "use .json, .csv, .stl, .obj, .ply, .step, .glb, .3mf or .urdf");
}

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
    case ExportKind::ClearanceMapPly:
    case ExportKind::ClearanceHistogramCsv:
    case ExportKind::AssemblyGlb:
    case ExportKind::AssemblyThreeMf:
    case ExportKind::AssemblyUrdf:
    case ExportKind::AssemblyStep:
      break;
  }
  return std::nullopt;
}

bool isAssembly(ExportKind kind) noexcept {
  return kind == ExportKind::AssemblyGlb || kind == ExportKind::AssemblyThreeMf ||
         kind == ExportKind::AssemblyUrdf || kind == ExportKind::AssemblyStep;
}

bool hasChosenParts(ExportKind kind) noexcept {
  return meshKindOf(kind) || isAssembly(kind);
}

bool hasUnitOfChoice(ExportKind kind) noexcept {
  return meshKindOf(kind) || kind == ExportKind::ClearanceMapPly || kind == ExportKind::AssemblyThreeMf;
}

std::string_view extensionOf(ExportKind kind) noexcept {
  if (const auto mesh = meshKindOf(kind)) return extensionOf(*mesh);
  switch (kind) {
    case ExportKind::ClearanceMapPly:
      return "ply";
    case ExportKind::AssemblyGlb:
      return "glb";
    case ExportKind::AssemblyThreeMf:
      return "3mf";
    case ExportKind::AssemblyUrdf:
      return "urdf";
    case ExportKind::AssemblyStep:
      return "step";
    case ExportKind::PlacementJson:
      return "json";
    default:
      return "csv";
  }
}

std::optional<ExportKind> exportKindOf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == kShortStep) return ExportKind::AssemblyStep;
  for (const ExportKind kind : kKinds) {
    if (extension == extensionOf(kind)) return kind;
  }
  return std::nullopt;
}

std::vector<std::string> exportScene(const Scene& scene, const RigidTransform& worldFromMoving,
                                     const SceneExport& what, const std::filesystem::path& file,
                                     const ProgressCallback& progress) {
  if (isAssembly(what.kind)) return exportAssembly(placedScene(scene, worldFromMoving), what, file, progress);
  if (const auto mesh = meshKindOf(what.kind)) {
    const Scene placed = placedScene(scene, worldFromMoving);
    exportMesh(chosenParts(placed, what.only), *mesh, what.metresPerUnit, file, progress);
  } else if (isMap(what.kind)) {
    exportMap(placedScene(scene, worldFromMoving), what, file, progress);
  } else if (what.kind == ExportKind::PlacementCsv) {
    atomicWrite(file, placementCsv(scene, worldFromMoving));
  } else {
    exportPlacement(scene, worldFromMoving, file);
  }
  return {};
}

}  // namespace nearfit
