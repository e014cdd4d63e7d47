#include "core/scene/part_geometry.h"

#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace nearfit {
namespace {

/// Reading and building the mesh, against deriving its mass properties: about the share of time.
constexpr double kImportShare = 0.9;

}  // namespace

std::filesystem::path normalisedPath(const std::filesystem::path& file) {
  std::error_code failure;
  const std::filesystem::path absolute = std::filesystem::absolute(file, failure);
  if (failure) return file;
  const std::filesystem::path folder = std::filesystem::weakly_canonical(absolute.parent_path(), failure);
  return failure ? absolute.lexically_normal() : folder / absolute.filename();
}

void checkMetresPerUnit(double metresPerUnit) {
  if (metresPerUnit >= kMinMetresPerUnit && metresPerUnit <= kMaxMetresPerUnit) return;
  throw UsageError("unit", fmt::format("{} metres to the unit is out of range", metresPerUnit),
                   fmt::format("give a value from {} to {} m", kMinMetresPerUnit, kMaxMetresPerUnit));
}

PartGeometryPtr loadPartGeometry(const std::filesystem::path& file, double metresPerUnit,
                                 const ProgressCallback& progress) {
  checkMetresPerUnit(metresPerUnit);
  MeshBuildOptions options;
  options.metresPerUnit = metresPerUnit;
  ProgressCallback importProgress;
  if (progress) importProgress = [&](double fraction) { return progress(kImportShare * fraction); };
  ImportedMesh imported = importMesh(file, options, importProgress);
  if (progress && !progress(kImportShare)) throw Cancelled();
  const MassProperties mass = massProperties(imported.mesh);
  if (progress && !progress(1.0)) throw Cancelled();
  return std::make_shared<const PartGeometry>(PartGeometry{normalisedPath(file), std::move(imported.sha256),
                                                           metresPerUnit, std::move(imported.mesh),
                                                           std::move(imported.report), mass});
}

void prepareHierarchies(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress) {
  const auto count = static_cast<double>(geometries.size());
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    ProgressCallback part;
    if (progress)
      part = [&, i](double fraction) { return progress((static_cast<double>(i) + fraction) / count); };
    geometries[i]->hierarchy->get(geometries[i]->mesh, part);
  }
}

}  // namespace nearfit
