#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Polygons as a file has them: before welding, triangulation and cleaning. In the file's units.
struct PolygonSoup {
  std::vector<glm::dvec3> vertices;
  std::vector<std::uint32_t> corners;  ///< Vertex indices of all polygons, one polygon after the other.
  std::vector<std::uint32_t> firstCorner{0};  ///< Polygon i has corners [firstCorner[i], firstCorner[i + 1]).

  std::size_t polygonCount() const noexcept { return firstCorner.size() - 1; }
  /// Makes a polygon of the corners added since the last one. Throws Error when there are too many corners.
  void closePolygon();
};

struct MeshBuildOptions {
  double metresPerUnit = 1.0;
  /// Vertices closer than this fraction of the bounding box's diagonal become one. 0 welds only equal ones.
  double weldTolerance = 1e-9;
};

/// What was done to a soup to make a mesh of it, and what is left wrong with the mesh.
struct MeshBuildReport {
  std::uint64_t weldedVertices = 0;
  std::uint64_t degenerateFaces = 0;  ///< Dropped: no area, or a corner repeated.
  std::uint64_t duplicateFaces = 0;   ///< Dropped: same corners in the same sense as another face.
  std::uint64_t nonFiniteFaces = 0;   ///< Dropped: they use a vertex that is not finite.
  std::uint64_t swappedFaces = 0;     ///< Lines (T-junctions), swapped with a neighbour for faces with area.
  std::uint64_t stitchedEdges = 0;    ///< Open edges that were closed (T-junctions): see t_junctions.h.
  bool turnedInsideOut = false;       ///< Closed pieces of negative volume were turned (cavities were not).
  std::vector<std::string> warnings;  ///< A sentence for each thing a user should know, with counts.
};

/// A mesh from a soup: scaled to metres, welded, polygons triangulated (concave ones too), cleaned, cracks
/// without width closed, turned.
/// Welding moves no vertex farther than the tolerance, so that chains of close vertices do not run together;
/// the first of those that become one stays where it is. The same soup gives the same mesh.
/// @param onProgress  Called now and then with the fraction done; may throw to stop the work. May be empty.
/// Throws Error when nothing is left, an index is out of range, or a limit is passed; UsageError for options
/// that make no sense.
TriangleMesh buildMesh(const PolygonSoup& soup, const MeshBuildOptions& options, MeshBuildReport& report,
                       const std::function<void(double fraction)>& onProgress = {});

}  // namespace nearfit
