#include "core/report/clearance_map_export.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/report/clearance_colours.h"
#include "core/report/mesh_file.h"
#include "core/scene/mesh_unit.h"

namespace nearfit {
namespace {

/// Numbers of a map's file.
struct MapFileSize {
  std::uint64_t vertices = 0, triangles = 0;
};

bool isNear(const MappedSurface& mapped, const Triangle& triangle) noexcept {
  return std::ranges::any_of(triangle,
                             [&](std::uint32_t corner) { return !std::isnan(mapped.distances[corner]); });
}

/// True for each sample that is a corner of a triangle that is written.
std::vector<bool> writtenSamples(const MappedSurface& mapped) {
  std::vector<bool> isWritten(mapped.surface->points.size());
  for (const Triangle& triangle : mapped.surface->triangles) {
    if (!isNear(mapped, triangle)) continue;
    for (const std::uint32_t corner : triangle)
      isWritten[corner] = true;
  }
  return isWritten;
}

MapFileSize mapFileSize(const ClearanceMap& map, std::span<const std::vector<bool>> written) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
  MapFileSize size;
  for (std::size_t i = 0; i < map.surfaces.size(); ++i) {
    const MappedSurface& mapped = map.surfaces[i];
    size.vertices += static_cast<std::uint64_t>(std::ranges::count(written[i], true));
    size.triangles += static_cast<std::uint64_t>(std::ranges::count_if(
        mapped.surface->triangles, [&](const Triangle& triangle) { return isNear(mapped, triangle); }));
  }
  if (size.triangles == 0)
    throw UsageError("clearance map", fmt::format("no surface is within {} m of another part", map.range),
                     "choose a longer range");
  if (size.vertices > kMax || size.triangles > kMax)
    throw UsageError("clearance map", fmt::format("{} vertices are more than a file can hold", size.vertices),
                     "map fewer parts");
  return size;
}

void writeMapHeader(MeshFile& out, const ClearanceMap& map, const Scene& scene, const MapFileSize& size,
                    double metresPerUnit) {
  auto text = std::back_inserter(out.text());
  const std::string unit = meshUnitText(metresPerUnit);
  const double range = map.range / metresPerUnit;
  fmt::format_to(text,
                 "ply\nformat binary_little_endian 1.0\n"
                 "comment Nearfit clearance map; world frame; x, y, z and distance in {}; only triangles "
                 "with a corner within {:.6g}\n",
                 unit, range);
  for (const MappedSurface& mapped : map.surfaces)
    fmt::format_to(text, "comment part {}\n", scene.get(mapped.part).name);
  fmt::format_to(text, "comment distance in {}, nan beyond {:.6g}\n", unit, range);
  fmt::format_to(text,
                 "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
                 "property float nx\nproperty float ny\nproperty float nz\n"
                 "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                 "property double distance\nproperty uint part\n"
                 "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                 size.vertices, size.triangles);
}

void writeMapVertices(MeshFile& out, const MappedSurface& mapped, const std::vector<bool>& isWritten,
                      std::uint32_t part, const Colour& own, double range, double metresPerUnit) {
  const SampledSurface& surface = *mapped.surface;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    if (!isWritten[i]) continue;
    const glm::dvec3 at = mapped.worldFromPart.applyToPoint(surface.points[i]) / metresPerUnit;
    const glm::dvec3 normal = mapped.worldFromPart.applyToVector(surface.normals[i]);
    for (glm::length_t k = 0; k < 3; ++k)
      out.append(at[k]);
    for (glm::length_t k = 0; k < 3; ++k)
      out.append(static_cast<float>(normal[k]));
    const double distance = mapped.distances[i];
    out.append(std::isnan(distance) ? own : clearanceColour(distance, range));
    out.append(distance / metresPerUnit);
    out.append(part);
    out.step();
  }
}

/// @param first  Index of the surface's first vertex in the file.
/// @return       Index of the first vertex after it.
std::uint32_t writeMapTriangles(MeshFile& out, const MappedSurface& mapped,
                                const std::vector<bool>& isWritten, std::uint32_t first) {
  std::vector<std::uint32_t> indexOf(isWritten.size());
  for (std::size_t i = 0; i < isWritten.size(); ++i) {
    indexOf[i] = first;
    if (isWritten[i]) ++first;
  }
  for (const Triangle& triangle : mapped.surface->triangles) {
    if (!isNear(mapped, triangle)) continue;
    out.append(std::uint8_t{3});
    for (const std::uint32_t corner : triangle)
      out.append(indexOf[corner]);
    out.step();
  }
  return first;
}

}  // namespace

std::uint64_t exportClearanceMap(const ClearanceMap& map, const Scene& scene, double metresPerUnit,
                                 const std::filesystem::path& file, const ProgressCallback& progress) {
  checkMetresPerUnit(metresPerUnit);
  std::vector<std::vector<bool>> written;
  for (const MappedSurface& mapped : map.surfaces)
    written.push_back(writtenSamples(mapped));
  const MapFileSize size = mapFileSize(map, written);
  MeshFile out(file, size.vertices + size.triangles, progress);
  writeMapHeader(out, map, scene, size, metresPerUnit);
  for (std::size_t i = 0; i < map.surfaces.size(); ++i) {
    const MappedSurface& mapped = map.surfaces[i];
    writeMapVertices(out, mapped, written[i], static_cast<std::uint32_t>(i), scene.get(mapped.part).colour,
                     map.range, metresPerUnit);
  }
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < map.surfaces.size(); ++i)
    next = writeMapTriangles(out, map.surfaces[i], written[i], next);
  return out.commit();
}

}  // namespace nearfit
