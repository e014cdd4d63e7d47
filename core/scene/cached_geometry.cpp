#include "core/scene/cached_geometry.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/files/sha256.h"

namespace nearfit {
namespace {

/// The cache for meshes of at least that many triangles.
TreeCache cacheFor(std::size_t leastTriangles) {
  TreeCacheSettings settings = treeCacheSettings();
  settings.leastTriangles = leastTriangles;
  return TreeCache(std::move(settings));
}

std::size_t leastCachedOf(const PartGeometry& named) {
  return named.shapeKey.empty() ? kMinCachedTriangles : 0;
}

/// A repaired mesh is cached like that of another file; a mesh that came from no file is not.
std::optional<TreeCacheKey> cacheKeyOf(const PartGeometry& named) {
  if (named.cacheName.empty()) return std::nullopt;
  if (named.repairs.empty()) return TreeCacheKey{named.cacheName, named.metresPerUnit};
  return TreeCacheKey{sha256OfBytes(named.cacheName + ' ' + textOf(named.repairs)), named.metresPerUnit};
}

/// Replaces what the report says of defects that the mesh may no longer have.
void renewWarnings(const MeshTopology& before, const MeshTopology& after, MeshBuildReport& report) {
  const std::vector<std::string> old = topologyWarnings(before), now = topologyWarnings(after);
  std::erase_if(report.warnings, [&](const std::string& w) { return std::ranges::count(old, w) > 0; });
  report.warnings.insert(report.warnings.end(), now.begin(), now.end());
}

/// Normal of a triangle, as long as twice its area.
glm::dvec3 areaNormal(const TriangleMesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles()[triangle];
  const glm::dvec3& a = mesh.vertices()[t[0]];
  return glm::cross(mesh.vertices()[t[1]] - a, mesh.vertices()[t[2]] - a);
}

/// Faces of a repaired mesh, and their colours. Triangles that fill holes share a face of no known surface.
void followRepair(const TriangleMesh& before, const RepairedMesh& repaired, CachedShape& shape) {
  if (shape.surfaces == nullptr) return;
  SurfaceFaces faces;
  faces.faces = shape.surfaces->faces;
  const auto filled = static_cast<std::uint32_t>(faces.faces.size());
  faces.faceOfTriangle.reserve(repaired.originOf.size());
  std::vector<double> agreement(faces.faces.size(), 0.0);
  for (std::size_t i = 0; i < repaired.originOf.size(); ++i) {
    const std::uint32_t origin = repaired.originOf[i];
    if (origin == RepairedMesh::kNoOrigin) {
      faces.faceOfTriangle.push_back(filled);
      continue;
    }
    const std::uint32_t face = shape.surfaces->faceOfTriangle[origin];
    faces.faceOfTriangle.push_back(face);
    agreement[face] += glm::dot(areaNormal(repaired.mesh, i), areaNormal(before, origin));
  }
  turnFaces(faces.faces, agreement);
  if (std::ranges::find(faces.faceOfTriangle, filled) != faces.faceOfTriangle.end()) {
    faces.faces.emplace_back();
    if (!shape.faceColours.empty()) shape.faceColours.emplace_back();
  }
  shape.surfaces = std::make_shared<const SurfaceFaces>(std::move(faces));
}

}  // namespace

PartGeometry namedAs(const PartGeometry& geometry, MeshRepairs repairs) {
  PartGeometry named;
  named.file = geometry.file;
  named.sha256 = geometry.sha256;
  named.cacheName = geometry.cacheName;
  named.metresPerUnit = geometry.metresPerUnit;
  named.repairs = std::move(repairs);
  named.shapeKey = geometry.shapeKey;
  named.companions = geometry.companions;
  named.tessellation = geometry.tessellation;
  named.hasOwnUnit = geometry.hasOwnUnit;
  return named;
}

std::optional<CachedMesh> cachedMeshOf(const PartGeometry& named) {
  const std::optional<TreeCacheKey> key = cacheKeyOf(named);
  const std::optional<TreeCacheFile> file = key ? TreeCache().find(*key) : std::nullopt;
  std::optional<CachedMesh> kept = file ? file->mesh() : std::nullopt;
  if (kept && kept->shape.has_value() == named.shapeKey.empty()) return std::nullopt;
  return kept;
}

void storeMesh(const PartGeometry& named, const CachedMesh& mesh) {
  if (const std::optional<TreeCacheKey> key = cacheKeyOf(named))
    cacheFor(leastCachedOf(named)).store(*key, mesh, nullptr);
}

PartGeometryPtr cachedGeometry(PartGeometry named, CachedMesh loaded) {
  // Look again when the hierarchy is needed: another process may have stored it by then.
  const std::optional<TreeCacheKey> key = cacheKeyOf(named);
  const auto surface = std::make_shared<SurfaceOnDemand>();
  const auto find = [key, surface, mesh = loaded.mesh]() -> std::optional<NormalConeTree> {
    const std::optional<TreeCacheFile> file = key ? TreeCache().find(*key) : std::nullopt;
    std::optional<CachedTree> kept = file ? file->tree(mesh) : std::nullopt;
    if (!kept) return std::nullopt;
    surface->setSolid(kept->isSolid);
    return std::move(kept->tree);
  };
  // Determine solidity together with the hierarchy: waiting is acceptable here, and the result is cached.
  const auto keep = [key, least = leastCachedOf(named), loaded, surface](const NormalConeTree& tree) {
    const CachedTree kept{tree, surface->isSolid(tree)};
    if (key) cacheFor(least).store(*key, loaded, &kept);
  };
  named.hierarchy = std::make_shared<HierarchyOnDemand>(find, keep, loaded.report.coordinateRounding);
  named.surfaceOnDemand = surface;
  named.mesh = std::move(loaded.mesh);
  named.report = std::move(loaded.report);
  named.mass = loaded.mass;
  if (loaded.shape) {
    named.effectiveTessellation = {loaded.shape->chord, loaded.shape->angle};
    named.surfaces = std::move(loaded.shape->surfaces);
    named.faceColours = std::move(loaded.shape->faceColours);
    named.isExact = loaded.shape->isExact;
    named.exactVolume = loaded.shape->exactVolume;
    named.statedUnit = loaded.shape->statedUnit;
  }
  return std::make_shared<const PartGeometry>(std::move(named));
}

CachedMesh toCache(const PartGeometry& geometry) {
  CachedMesh mesh{geometry.mesh, geometry.report, geometry.mass};
  if (geometry.shapeKey.empty()) return mesh;
  mesh.shape = CachedShape{geometry.surfaces,
                           geometry.faceColours,
                           geometry.effectiveTessellation.chord,
                           geometry.effectiveTessellation.angle,
                           geometry.exactVolume,
                           geometry.isExact,
                           geometry.statedUnit};
  return mesh;
}

std::vector<RepairStep> repairCached(const std::filesystem::path& file, const MeshRepairs& repairs,
                                     const ProgressCallback& progress, CachedMesh& mesh) {
  try {
    RepairedMesh repaired = repairMesh(mesh.mesh, repairs, progress);
    if (repaired.mesh.sharesArraysOf(mesh.mesh)) {
      mesh.mass = massProperties(mesh.mesh);
      return std::move(repaired.steps);
    }
    renewWarnings(mesh.mesh.topology(), repaired.mesh.topology(), mesh.report);
    if (mesh.shape) followRepair(mesh.mesh, repaired, *mesh.shape);
    mesh.mesh = std::move(repaired.mesh);
    mesh.mass = massProperties(mesh.mesh);
    return std::move(repaired.steps);
  } catch (const UsageError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    throw FileError(file.string(), error.problem(), error.remedy());
  }
}

}  // namespace nearfit
