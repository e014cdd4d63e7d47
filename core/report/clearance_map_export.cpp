#include "core/report/clearance_map_export.h"

#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/report/clearance_colours.h"
#include "core/report/mesh_file.h"

namespace nearfit {
namespace {

/// Numbers of a map's file.
struct MapFileSize {
  std::uint64_t vertices = 0, triangles = 0;
};

MapFileSize mapFileSize(const ClearanceMap& map) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
  MapFileSize size;
  for (const MappedSurface& mapped : map.surfaces) {
    size.vertices += mapped.surface->points.size();
    size.triangles += mapped.surface->triangles.size();
  }
  if (size.vertices > kMax || size.triangles > kMax)
    throw UsageError("clearance map", fmt::format("{} vertices are more than a file can hold", size.vertices),
                     "map fewer parts");
  return size;
}

void writeMapHeader(MeshFile& out, const ClearanceMap& map, const Scene& scene, const MapFileSize& size,
                    double metresPerUnit) {
  auto text = std::back_inserter(out.text());
  fmt::format_to(
      text,
      "ply\nformat binary_little_endian 1.0\n"
      "comment Nearfit clearance map; world frame; {} m to the unit; distance in m, nan beyond {} m\n",
      metresPerUnit, map.range);
  for (const MappedSurface& mapped : map.surfaces)
    fmt::format_to(text, "comment part {}\n", scene.get(mapped.part).name);
  fmt::format_to(text,
                 "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
                 "property float nx\nproperty float ny\nproperty float nz\n"
                 "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                 "property double distance\nproperty uint part\n"
                 "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                 size.vertices, size.triangles);
}

void writeMapVertices(MeshFile& out, const MappedSurface& mapped, std::uint32_t part, const Colour& own,
                      double range, double metresPerUnit) {
  const SampledSurface& surface = *mapped.surface;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const glm::dvec3 at = mapped.worldFromPart.applyToPoint(surface.points[i]) / metresPerUnit;
    const glm::dvec3 normal = mapped.worldFromPart.applyToVector(surface.normals[i]);
    for (glm::length_t k = 0; k < 3; ++k)
      out.append(at[k]);
    for (glm::length_t k = 0; k < 3; ++k)
      out.append(static_cast<float>(normal[k]));
    const double distance = mapped.distances[i];
    out.append(std::isnan(distance) ? own : clearanceColour(distance, range));
    out.append(distance);
    out.append(part);
    out.step();
  }
}

}  // namespace

std::uint64_t exportClearanceMap(const ClearanceMap& map, const Scene& scene, double metresPerUnit,
                                 const std::filesystem::path& file, const ProgressCallback& progress) {
  checkMetresPerUnit(metresPerUnit);
  const MapFileSize size = mapFileSize(map);
  MeshFile out(file, size.vertices + size.triangles, progress);
  writeMapHeader(out, map, scene, size, metresPerUnit);
  std::uint32_t part = 0;
  for (const MappedSurface& mapped : map.surfaces)
    writeMapVertices(out, mapped, part++, scene.get(mapped.part).colour, map.range, metresPerUnit);
  std::uint32_t first = 0;
  for (const MappedSurface& mapped : map.surfaces) {
    for (const Triangle& t : mapped.surface->triangles) {
      out.append(std::uint8_t{3});
      for (const std::uint32_t corner : t)
        out.append(first + corner);
      out.step();
    }
    first += static_cast<std::uint32_t>(mapped.surface->points.size());
  }
  return out.commit();
}

}  // namespace nearfit
