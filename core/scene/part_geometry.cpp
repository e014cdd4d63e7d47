#include "core/scene/part_geometry.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/import/mesh_file_check.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/proximity/cache/tree_cache.h"
#include "core/scene/cached_geometry.h"
#include "core/scene/document_load.h"

namespace nearfit {
namespace {

/// Progress after hashing, and after building the mesh; mass properties follow. Roughly the shares of time.
constexpr double kHashed = 0.05, kImported = 0.95;
/// Progress after building a mesh that is to be repaired.
constexpr double kImportedToRepair = 0.5;
/// Progress of loading shapes after which their repairs follow.
constexpr double kShapesLoaded = 0.7;
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

/// Null if the file's SHA-256 is not the required one.
PartGeometryPtr load(const MeshSource& source, const ProgressCallback& progress) {
  checkMetresPerUnit(source.metresPerUnit);
  checkRepairs(source.repairs);
  if (!source.shape.empty()) {
    throw UsageError(source.file.string(),
                     fmt::format("it has no shape \"{}\": only CAD documents have shapes", source.shape),
                     "name the file alone");
  }
  const auto isWanted = [&](const std::string& sha256) {
    return source.sha256.empty() || sha256 == source.sha256;
  };
  checkMeshFile(source.file);
  std::string sha256 = sha256OfFile(source.file, stageOf(progress, 0.0, kHashed));
  if (!isWanted(sha256)) return nullptr;
  PartGeometry geometry;
  geometry.file = normalisedPath(source.file);
  geometry.sha256 = geometry.cacheName = std::move(sha256);
  geometry.metresPerUnit = source.metresPerUnit;
  geometry.repairs = source.repairs;
  std::optional<CachedMesh> kept = cachedMeshOf(geometry);
  if (!kept) {
    MeshBuildOptions options;
    options.metresPerUnit = source.metresPerUnit;
    const double imports = source.repairs.empty() ? kImported : kImportedToRepair;
    ImportedMesh imported = importMesh(source.file, options, stageCallback(progress, kHashed, imports));
    // The file may have changed since it was hashed. Its content when it was read counts.
    geometry.sha256 = geometry.cacheName = std::move(imported.sha256);
    if (!isWanted(geometry.sha256)) return nullptr;
    kept = CachedMesh{std::move(imported.mesh), std::move(imported.report), {}};
    if (source.repairs.empty())
      kept->mass = massProperties(kept->mesh);
    else
      repairCached(source.file, source.repairs, stageCallback(progress, kImportedToRepair, kImported), *kept);
    storeMesh(geometry, *kept);
  }
  stageOf(progress, kImported, 1.0)(1.0);
  return cachedGeometry(std::move(geometry), std::move(*kept));
}

/// Time that exact surfaces take for each byte, against a mesh file's. Roughly.
constexpr double kDocumentCost = 20.0;

/// Rough cost of loading the file.
double weightOf(const std::filesystem::path& file) {
  std::error_code failure;
  const std::uintmax_t bytes = std::filesystem::file_size(file, failure);
  const double cost = isDocumentFile(file) ? kDocumentCost : 1.0;
  return failure ? 1.0 : 1.0 + cost * static_cast<double>(bytes);
}

/// Sources that are loaded as one: a mesh file, or shapes of one document.
struct LoadGroup {
  std::vector<std::size_t> sources;  ///< Indices.
  bool isDocument;
};

std::vector<LoadGroup> loadGroupsOf(std::span<const MeshSource> sources) {
  using Key = std::tuple<std::filesystem::path, double, std::string, double, double>;
  std::vector<LoadGroup> groups;
  std::map<Key, std::size_t> known;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const MeshSource& source = sources[i];
    const bool isDocument = isDocumentFile(source.file);
    std::size_t group = groups.size();
    if (isDocument) {
      group = known
                  .try_emplace({normalisedPath(source.file), source.metresPerUnit, source.sha256,
                                source.tessellation.chord, source.tessellation.angle},
                               group)
                  .first->second;
    }
    if (group == groups.size()) groups.push_back({{}, isDocument});
    groups[group].sources.push_back(i);
  }
  return groups;
}

/// The geometry with repairs besides, from the cache if it is there.
PartGeometryPtr withRepairs(const PartGeometry& original, const MeshRepairs& repairs,
                            const ProgressCallback& progress) {
  checkRepairs(repairs);
  PartGeometry geometry = namedAs(original, repairs);
  std::optional<CachedMesh> kept = cachedMeshOf(geometry);
  if (!kept) {
    kept = toCache(original);
    repairCached(original.file, repairs, progress, *kept);
    storeMesh(geometry, *kept);
  }
  return cachedGeometry(std::move(geometry), std::move(*kept));
}

/// Loads shapes of one document, and makes their repairs. Equal sources share a geometry.
std::vector<LoadedPart> loadDocumentShapes(std::span<const MeshSource> shapes,
                                           const ProgressCallback& progress) {
  const bool areRepaired =
      std::ranges::any_of(shapes, [](const MeshSource& s) { return !s.repairs.empty(); });
  std::vector<LoadedPart> parts =
      loadShapes(shapes, stageCallback(progress, 0.0, areRepaired ? kShapesLoaded : 1.0));
  std::map<std::pair<std::string, std::string>, LoadedPart> known;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const MeshSource& source = shapes[i];
    if (parts[i].geometry == nullptr || parts[i].geometry->repairs == source.repairs) continue;
    const auto [it, isNew] = known.try_emplace({source.shape, textOf(source.repairs)});
    if (isNew) {
      try {
        it->second.geometry =
            withRepairs(*parts[i].geometry, source.repairs, stageCallback(progress, kShapesLoaded, 1.0));
      } catch (const Cancelled&) {
        throw;
      } catch (...) {
        it->second.problem = std::current_exception();
      }
    }
    parts[i] = it->second;
  }
  return parts;
}

void loadGroup(const LoadGroup& group, std::span<const MeshSource> sources, const ProgressCallback& progress,
               std::vector<LoadedPart>& loaded) {
  if (group.isDocument) {
    std::vector<MeshSource> shapes;
    for (const std::size_t i : group.sources)
      shapes.push_back(sources[i]);
    std::vector<LoadedPart> parts = loadDocumentShapes(shapes, progress);
    for (std::size_t k = 0; k < parts.size(); ++k)
      loaded[group.sources[k]] = std::move(parts[k]);
    return;
  }
  const std::size_t i = group.sources.front();
  try {
    loaded[i].geometry = load(sources[i], progress);
  } catch (const Cancelled&) {
    throw;
  } catch (...) {
    loaded[i].problem = std::current_exception();
  }
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
  checkMetresPerUnit(metresPerUnit);
  const MeshSource source{file, unitToOpen(file, metresPerUnit)};
  if (!isDocumentFile(file)) return load(source, progress);
  const LoadedPart loaded = loadShapes({&source, 1}, progress).front();
  if (loaded.problem) std::rethrow_exception(loaded.problem);
  return loaded.geometry;
}

GeometryRepair repairGeometry(const PartGeometry& original, const MeshRepairs& repairs,
                              const ProgressCallback& progress) {
  MeshRepairs all = original.repairs;
  all.insert(all.end(), repairs.begin(), repairs.end());
  checkRepairs(all);
  CachedMesh made = toCache(original);
  GeometryRepair repair;
  repair.steps = repairCached(original.file, repairs, stageCallback(progress, 0.0, kRepaired), made);
  repair.change = changeBetween(original.mesh, made.mesh, stageCallback(progress, kRepaired, kCompared));
  if (made.mesh.sharesArraysOf(original.mesh)) return repair;
  PartGeometry geometry = namedAs(original, all);
  storeMesh(geometry, made);
  repair.geometry = cachedGeometry(std::move(geometry), std::move(made));
  stageOf(progress, 0.0, 1.0)(1.0);
  return repair;
}

std::vector<LoadedPart> loadPartGeometries(std::span<const MeshSource> sources,
                                           const ProgressCallback& progress) {
  const std::vector<LoadGroup> groups = loadGroupsOf(sources);
  std::vector<double> weights;
  for (const LoadGroup& group : groups)
    weights.push_back(weightOf(sources[group.sources.front()].file));
  SharedProgress all(progress, std::max(1.0, std::accumulate(weights.begin(), weights.end(), 0.0)));
  std::vector<LoadedPart> loaded(sources.size());
  parallelFor(groups.size(), [&](std::size_t i) {
    TaskProgress own(all, weights[i]);
    loadGroup(groups[i], sources, own.callback(), loaded);
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
