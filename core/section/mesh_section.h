#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"
#include "core/section/cut_plane.h"

namespace nearfit {

/// Section of a mesh by a plane, in the mesh's frame.
struct MeshSection {
  std::vector<glm::dvec3> points;  ///< Points of the outline, on the mesh's edges [m].
  /// Segments of the outline, as indices into `points`. Seen against the plane's normal, the
  /// material is on the left.
  std::vector<std::array<std::uint32_t, 2>> outline;
  std::vector<glm::dvec3> capPoints;  ///< [m]
  std::vector<Triangle> cap;          ///< Fills the outline; anticlockwise seen against the normal.
  bool isCapped = false;              ///< True if the mesh is closed and its outline, if any, is filled.
};

/// Cuts a mesh by a plane. Vertices in the plane, within rounding, count as not cut away. So each curve of a
/// closed mesh closes, whatever lies in the plane.
///
/// Components may overlap and be nested: the cap is what the surface winds around. If the mesh is not
/// consistently oriented, the cap follows the even-odd rule. There is no cap if the mesh is open or the
/// outline has more than 25,000 segments. O(n) in the triangles plus O(k log k) in the k that are cut;
/// immediate if the plane misses the bounding box. For the GUI thread.
MeshSection sectionOf(const TriangleMesh& mesh, const CutPlane& plane);

/// True if a point of the plane, in the mesh's frame, is on the cap. O(n) in the cap's triangles.
/// @param normal  Of the plane; unit.
bool isOnCap(const MeshSection& section, const glm::dvec3& normal, const glm::dvec3& point) noexcept;

}  // namespace nearfit
