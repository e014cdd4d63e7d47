#pragma once

#include <cstddef>
#include <optional>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

/// Volume that two solids share, by ways that share nothing with the program's corefinement.
namespace nearfit::test {

/// Intersects Nef polyhedra in exact arithmetic; the part's vertices are rounded where the pose puts them.
/// No value if a mesh does not bound a solid that they can be made of. Takes about a millisecond a triangle.
/// Source: Hachenberger, Kettner and Mehlhorn 2007, in CGAL.
std::optional<double> sharedVolumeByNef(const TriangleMesh& scene, const TriangleMesh& part,
                                        const RigidTransform& sceneFromPart);

/// Sums the lengths of parallel rays, one for each cell of a grid aslant to all axes, that lie in both solids.
/// Its error falls with the square of the cells' edge.
/// @param cells  Along each side of the grid, which covers what the boxes of the two share.
double sharedVolumeByRays(const TriangleMesh& scene, const TriangleMesh& part,
                          const RigidTransform& sceneFromPart, std::size_t cells);

}  // namespace nearfit::test
