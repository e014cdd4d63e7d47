#pragma once

#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// How far from an edge a vertex may lie and count as on it, as a fraction of the mesh's diagonal: some ten
/// roundings of coordinates to single precision, which is what most files hold. The vertices that leave
/// cracks in CAD exports lie on their edges to less.
constexpr double kOnEdge = 1e-6;

/// Closes cracks without width: open edges on which vertices of the other side lie (T-junctions), as exports
/// have them where one face was subdivided and its neighbour was not. Each triangle with such an edge is
/// split at those vertices, where every piece of the edge then meets just one other open edge that runs along
/// it the other way. No vertex moves, the surface moves by kOnEdge at most, and orientation stays. Edges that
/// that would not close stay as they are, and so does the whole of a mesh so torn that looking would take
/// seconds.
/// @return Triangles for the same vertices: number i is number i of the mesh, or a piece of it; further
/// pieces
///         follow behind. Empty when there is nothing to close. About O(n log n) in open edges.
std::vector<Triangle> stitchTJunctions(const TriangleMesh& mesh);

}  // namespace nearfit
