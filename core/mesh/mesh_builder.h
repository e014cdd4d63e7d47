#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Polygons as read from a file, before welding, triangulation and cleaning. In the file's units.
struct PolygonSoup {
  std::vector<glm::dvec3> vertices;
  std::vector<std::uint32_t> corners;         ///< Vertex indices of all polygons, one after the other.
  std::vector<std::uint32_t> firstCorner{0};  ///< Polygon i has corners [firstCorner[i], firstCorner[i + 1]).

  std::size_t polygonCount() const noexcept { return firstCorner.size() - 1; }
  /// Ends a polygon made of the corners added since the last one. Throws Error if there are too many corners.
  void closePolygon();
};

/// Options of buildMesh().
struct MeshBuildOptions {
  /// Scale from the soup's units [m]; finite, > 0.
  double metresPerUnit = 1.0;
  /// Vertices closer than this fraction of the bounding box's diagonal are merged; 0 to 0.1. 0 merges
  /// only equal ones.
  double weldTolerance = 1e-9;
};

/// What was changed to make a mesh from a soup, and the defects that remain.
struct MeshBuildReport {
  std::uint64_t weldedVertices = 0;
  std::uint64_t degenerateFaces = 0;  ///< Dropped: no area, or a repeated corner.
  std::uint64_t duplicateFaces = 0;   ///< Dropped: same corners in the same sense as another face.
  std::uint64_t nonFiniteFaces = 0;   ///< Dropped: a vertex is not finite.
  std::uint64_t swappedFaces = 0;     ///< Lines (T-junctions) swapped with a neighbour; see flat_triangles.h.
  std::uint64_t stitchedEdges = 0;    ///< Open edges closed (T-junctions); see t_junctions.h.
  /// Max rounding error of a coordinate, as the file's own numbers show it [m]; see coordinateRounding().
  double coordinateRounding = 0.0;
  bool turnedInsideOut = false;  ///< Closed components of negative volume were flipped (cavities were not).
  std::vector<std::string> warnings;  ///< One sentence with counts for each defect that a user should know.
};

/// Condition of a mesh after loading, by what its warnings tell.
enum class MeshCondition : std::uint8_t {
  Sound,     ///< No warning.
  Mended,    ///< Each defect was mended, and none remains.
  Doubtful,  ///< Its edges are as they should be, but its reader warned: its file may be cut off.
  Open,      ///< Open, non-manifold or inconsistent edges remain.
};

/// @param report  From loading `mesh`; its warnings may include those of a reader.
MeshCondition conditionOf(const TriangleMesh& mesh, const MeshBuildReport& report);

/// A sentence for each kind of defect of a mesh, as in MeshBuildReport::warnings.
std::vector<std::string> topologyWarnings(const MeshTopology& topology);

/// Builds a mesh from a soup: scales it to metres, welds vertices, triangulates polygons (concave ones too),
/// drops invalid faces, closes cracks of zero width, and flips what is inside out.
///
/// Welding moves no vertex farther than the tolerance, so chains of close vertices do not collapse; the first
/// of the merged vertices keeps its position. Deterministic.
/// @param report      Overwritten.
/// @param onProgress  Called now and then with the fraction done; may throw to stop the work. May be empty.
/// @param polygonOfTriangle  Receives the polygon of the soup that each triangle of the mesh came from, whatever was
///                           dropped, swapped and cut. May be null.
/// Throws Error if nothing is left, an index is out of range or a limit is exceeded; UsageError if an
/// option is invalid.
TriangleMesh buildMesh(const PolygonSoup& soup, const MeshBuildOptions& options, MeshBuildReport& report,
                       const std::function<void(double fraction)>& onProgress = {},
                       std::vector<std::uint32_t>* polygonOfTriangle = nullptr);

}  // namespace nearfit
