#include "core/scene/part_geometry.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/import/mesh_file_check.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/proximity/cache/tree_cache.h"

namespace nearfit {
namespace {

/// Progress after hashing, and after building the mesh; mass properties follow. Roughly the shares of time.
constexpr double kHashed = 0.05, kImported = 0.95;
/// Progress after building a mesh that is to be repaired.
constexpr double kImportedToRepair = 0.5;
/// Share of repairGeometry() that goes into the repairs; the rest measures what they changed.
constexpr double kRepaired = 0.6, kCompared = 0.95;

/// One task's share of the total progress. Never counts backward.
class TaskProgress {
 public:
  TaskProgress(SharedProgress& all, double weight) : all_(all), weight_(weight) {}
  ProgressCallback callback() {
    return [this](double fraction) {
      const double from = std::exchange(done_, std::max(done_, fraction));
      all_.add(weight_ * (done_ - from));
      return true;
    };
  }

 private:
  SharedProgress& all_;
  const double weight_;
  double done_ = 0.0;
};

/// A repaired mesh is cached like that of another file.
TreeCacheKey cacheKeyOf(const std::string& sha256, double metresPerUnit, const MeshRepairs& repairs) {
  if (repairs.empty()) return {sha256, metresPerUnit};
  return {sha256OfBytes(sha256 + ' ' + textOf(repairs)), metresPerUnit};
}

PartGeometryPtr makeGeometry(const MeshSource& source, std::string sha256, CachedMesh&& loaded) {
  // Look again when the hierarchy is needed: another process may have stored it by then.
  const TreeCacheKey key = cacheKeyOf(sha256, source.metresPerUnit, source.repairs);
  const auto surface = std::make_shared<SurfaceOnDemand>();
  const auto find = [key, surface, mesh = loaded.mesh]() -> std::optional<NormalConeTree> {
    const std::optional<TreeCacheFile> file = TreeCache().find(key);
    std::optional<CachedTree> kept = file ? file->tree(mesh) : std::nullopt;
    if (!kept) return std::nullopt;
    surface->setSolid(kept->isSolid);
    return std::move(kept->tree);
  };
  // Determine solidity together with the hierarchy: waiting is acceptable here, and the result is cached.
  const auto keep = [key, loaded, surface](const NormalConeTree& tree) {
    const CachedTree kept{tree, surface->isSolid(tree)};
    TreeCache().store(key, loaded, &kept);
  };
  const double rounding = loaded.report.coordinateRounding;
  return std::make_shared<const PartGeometry>(
      PartGeometry{normalisedPath(source.file), std::move(sha256), source.metresPerUnit,
                   std::move(loaded.mesh), std::move(loaded.report), loaded.mass,
                   std::make_shared<HierarchyOnDemand>(find, keep, rounding), surface, source.repairs});
}

/// Replaces what the report says of defects that the mesh may no longer have.
void renewWarnings(const MeshTopology& before, const MeshTopology& after, MeshBuildReport& report) {
  const std::vector<std::string> old = topologyWarnings(before), now = topologyWarnings(after);
  std::erase_if(report.warnings, [&](const std::string& w) { return std::ranges::count(old, w) > 0; });
  report.warnings.insert(report.warnings.end(), now.begin(), now.end());
}

/// Runs repairs of a file's mesh; its errors name the file.
RepairedMesh repaired(const std::filesystem::path& file, const TriangleMesh& mesh, const MeshRepairs& repairs,
                      const ProgressCallback& progress) {
  try {
    return repairMesh(mesh, repairs, progress);
  } catch (const UsageError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    throw FileError(file.string(), error.problem(), error.remedy());
  }
}

/// Null if the file's SHA-256 is not the required one.
PartGeometryPtr load(const MeshSource& source, const ProgressCallback& progress) {
  checkMetresPerUnit(source.metresPerUnit);
  checkRepairs(source.repairs);
  const TreeCache cache;
  const auto isWanted = [&](const std::string& sha256) {
    return source.sha256.empty() || sha256 == source.sha256;
  };
  checkMeshFile(source.file);
  std::string sha256 = sha256OfFile(source.file, stageOf(progress, 0.0, kHashed));
  if (!isWanted(sha256)) return nullptr;
  std::optional<CachedMesh> kept;
  if (const auto file = cache.find(cacheKeyOf(sha256, source.metresPerUnit, source.repairs)))
    kept = file->mesh();
  if (!kept) {
    MeshBuildOptions options;
    options.metresPerUnit = source.metresPerUnit;
    const double imports = source.repairs.empty() ? kImported : kImportedToRepair;
    ImportedMesh imported = importMesh(source.file, options, stageCallback(progress, kHashed, imports));
    // The file may have changed since it was hashed. Its content when it was read counts.
    sha256 = std::move(imported.sha256);
    if (!isWanted(sha256)) return nullptr;
    kept = CachedMesh{std::move(imported.mesh), std::move(imported.report), {}};
    if (!source.repairs.empty()) {
      const ProgressCallback stage = stageCallback(progress, kImportedToRepair, kImported);
      RepairedMesh result = repaired(source.file, kept->mesh, source.repairs, stage);
      renewWarnings(kept->mesh.topology(), result.mesh.topology(), kept->report);
      kept->mesh = std::move(result.mesh);
    }
    kept->mass = massProperties(kept->mesh);
    cache.store(cacheKeyOf(sha256, source.metresPerUnit, source.repairs), *kept, nullptr);
  }
  stageOf(progress, kImported, 1.0)(1.0);
  return makeGeometry(source, std::move(sha256), std::move(*kept));
}

/// Rough cost of loading the file.
double weightOf(const std::filesystem::path& file) {
  std::error_code failure;
  const std::uintmax_t bytes = std::filesystem::file_size(file, failure);
  return failure ? 1.0 : 1.0 + static_cast<double>(bytes);
}

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
  throw UsageError("unit", fmt::format("{} metres per unit is out of range", metresPerUnit),
                   fmt::format("give a value from {} to {} m", kMinMetresPerUnit, kMaxMetresPerUnit));
}

PartGeometryPtr loadPartGeometry(const std::filesystem::path& file, double metresPerUnit,
                                 const ProgressCallback& progress) {
  return load({file, metresPerUnit, {}}, progress);
}

GeometryRepair repairGeometry(const PartGeometry& original, const MeshRepairs& repairs,
                              const ProgressCallback& progress) {
  MeshSource source{original.file, original.metresPerUnit, original.sha256, original.repairs};
  source.repairs.insert(source.repairs.end(), repairs.begin(), repairs.end());
  checkRepairs(source.repairs);
  const ProgressCallback repairing = stageCallback(progress, 0.0, kRepaired),
                         comparing = stageCallback(progress, kRepaired, kCompared);
  RepairedMesh result = repaired(original.file, original.mesh, repairs, repairing);
  GeometryRepair repair{nullptr, std::move(result.steps),
                        changeBetween(original.mesh, result.mesh, comparing)};
  if (result.mesh.sharesArraysOf(original.mesh)) return repair;
  CachedMesh made{std::move(result.mesh), original.report, {}};
  renewWarnings(original.mesh.topology(), made.mesh.topology(), made.report);
  made.mass = massProperties(made.mesh);
  TreeCache().store(cacheKeyOf(original.sha256, source.metresPerUnit, source.repairs), made, nullptr);
  repair.geometry = makeGeometry(source, original.sha256, std::move(made));
  stageOf(progress, 0.0, 1.0)(1.0);
  return repair;
}

std::vector<LoadedPart> loadPartGeometries(std::span<const MeshSource> sources,
                                           const ProgressCallback& progress) {
  std::vector<double> weights;
  for (const MeshSource& source : sources)
    weights.push_back(weightOf(source.file));
  SharedProgress all(progress, std::max(1.0, std::accumulate(weights.begin(), weights.end(), 0.0)));
  std::vector<LoadedPart> loaded(sources.size());
  parallelFor(sources.size(), [&](std::size_t i) {
    TaskProgress own(all, weights[i]);
    try {
      loaded[i].geometry = load(sources[i], own.callback());
    } catch (const Cancelled&) {
      throw;
    } catch (...) {
      loaded[i].problem = std::current_exception();
    }
    own.callback()(1.0);
  });
  return loaded;
}

void prepareHierarchies(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress) {
  std::vector<PartGeometryPtr> missing;
  for (const PartGeometryPtr& geometry : geometries) {
    if (!geometry->hierarchy->isReady()) missing.push_back(geometry);
  }
  // Parts may share a geometry. Start with the largest, so that smaller ones fill the gaps.
  const auto weight = [](const PartGeometryPtr& geometry) {
    return 1.0 + static_cast<double>(geometry->mesh.triangles().size());
  };
  std::ranges::sort(missing);
  const auto repeated = std::ranges::unique(missing);
  missing.erase(repeated.begin(), repeated.end());
  std::ranges::stable_sort(missing, std::greater<>(), weight);
  double total = 0.0;
  for (const PartGeometryPtr& geometry : missing)
    total += weight(geometry);
  SharedProgress all(progress, std::max(1.0, total));
  parallelFor(missing.size(), [&](std::size_t i) {
    TaskProgress own(all, weight(missing[i]));
    missing[i]->hierarchy->get(missing[i]->mesh, own.callback());
  });
  if (progress) progress(1.0);
}

bool areHierarchiesReady(std::span<const PartGeometryPtr> geometries) noexcept {
  return std::ranges::all_of(geometries, [](const auto& geometry) { return geometry->hierarchy->isReady(); });
}

}  // namespace nearfit
