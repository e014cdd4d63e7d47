#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"
#include "core/placing/feature_pick.h"
#include "core/section/cut_plane.h"

namespace nearfit {

/// Where a plane cuts a mesh, in the mesh's frame.
struct MeshSection {
  std::vector<glm::dvec3> points;  ///< Of the outline, on the mesh's edges [m].
  /// Segments, ends by index; seen against the plane's normal, the material lies on the left.
  std::vector<std::array<std::uint32_t, 2>> outline;
  std::vector<glm::dvec3> capPoints;  ///< [m]
  std::vector<Triangle> cap;          ///< Fills the outline; anticlockwise seen against the normal.
  bool isCapped = false;              ///< The mesh is closed: there is something to fill, and it is.
};

/// Cuts a mesh by a plane. Corners in the plane, and as near to it as rounding may shift them, count as not
/// cut away, so that each curve of a closed mesh closes whatever lies in the plane.
///
/// Pieces may overlap and lie in each other: the cap is what the surface winds around. Where its triangles
/// have no common sense, the cap goes by parity. An open mesh has none, nor has one cut 25,000 times.
/// O(n) of the triangles, and O(k log k) of the k that are cut; at once where the plane misses the bounds.
/// For the GUI thread.
MeshSection sectionOf(const TriangleMesh& mesh, const CutPlane& plane);

/// Whether a point of the plane, in the mesh's frame, lies on the cap. O(n) of its triangles.
///
/// @param normal  The plane's; unit.
bool isOnCap(const MeshSection& section, const glm::dvec3& normal, const glm::dvec3& point) noexcept;

/// What somebody means who points at a cap: the outline near by, as an edge, else the very point. Nothing
/// where a face is looked for, or an axis and no outline is near.
///
/// @param point  Of the cap, in the mesh's frame [m]; becomes the point of the outline that is meant.
/// @param reach  How far the outline may be to be meant [m]; >= 0.
std::optional<PickedFeature> pickFeature(const MeshSection& section, glm::dvec3& point, double reach,
                                         FeatureFilter filter = FeatureFilter::Any);

}  // namespace nearfit
