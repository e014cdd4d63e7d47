#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Max distance of a vertex from an edge it lies on, as a fraction of the mesh's diagonal: about ten
/// roundings to single precision, which most files use. Vertices that cause cracks in CAD exports are
/// closer than that.
constexpr double kOnEdge = 1e-6;

/// Closes cracks of zero width (T-junctions): open edges on which vertices of the other side lie. Exporters
/// leave them where they subdivide a face but not its neighbour. Splits each triangle with such an edge at
/// those vertices, if every segment of the edge then meets exactly one other open edge that runs the other
/// way. No vertex moves, the surface moves by at most kOnEdge of the mesh's diagonal, and orientation stays.
/// Edges that would not close stay as they are. So does a mesh so torn that the search would take seconds.
/// @param origins  Receives the triangle of the mesh that each returned one is, or is a fragment of. May be null.
/// @return Triangles over the same vertices. Triangle i is triangle i of the mesh or a fragment of it;
/// further fragments follow. Empty if there is nothing to close. About O(n log n) in open edges.
std::vector<Triangle> stitchTJunctions(const TriangleMesh& mesh,
                                       std::vector<std::uint32_t>* origins = nullptr);

/// The same for wider cracks.
/// @param reach     Max distance of a vertex from an edge it is taken to lie on [m]; finite, >= 0.
/// @param originOf  Receives the triangle of the mesh that each triangle is a fragment of.
std::vector<Triangle> stitchTJunctions(const TriangleMesh& mesh, double reach,
                                       std::vector<std::uint32_t>& originOf);

}  // namespace nearfit
