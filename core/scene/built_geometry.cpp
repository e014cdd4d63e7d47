#include "core/scene/built_geometry.h"

#include <memory>
#include <utility>

#include "core/files/sha256.h"
#include "core/mesh/mass_properties.h"
#include "core/mesh/mesh_builder.h"

namespace nearfit {

PartGeometryPtr builtGeometry(std::vector<glm::dvec3> vertices, const std::vector<Triangle>& triangles) {
  PolygonSoup soup;
  soup.vertices = std::move(vertices);
  soup.corners.reserve(3 * triangles.size());
  soup.firstCorner.reserve(triangles.size() + 1);
  for (const Triangle& triangle : triangles) {
    soup.corners.insert(soup.corners.end(), triangle.begin(), triangle.end());
    soup.closePolygon();
  }
  PartGeometry geometry;
  geometry.mesh = buildMesh(soup, {}, geometry.report);
  geometry.mass = massProperties(geometry.mesh);
  geometry.hierarchy = std::make_shared<HierarchyOnDemand>(
      HierarchyOnDemand::Find{}, HierarchyOnDemand::Keep{}, geometry.report.coordinateRounding);
  return std::make_shared<const PartGeometry>(std::move(geometry));
}

PartGeometryPtr namedGeometry(const PartGeometry& built, const std::filesystem::path& file) {
  PartGeometry geometry = built;
  geometry.file = normalisedPath(file);
  geometry.sha256 = geometry.cacheName = sha256OfFile(file);
  geometry.metresPerUnit = 1.0;
  return std::make_shared<const PartGeometry>(std::move(geometry));
}

}  // namespace nearfit
