#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/mesh/flat_groups.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// A mesh whose flats are cut into as few triangles as their outlines need, so that what it costs to search it
/// does not depend on how finely its flats were cut.
struct FlatMesh {
  TriangleMesh mesh;
  /// By triangle: its flat, or kNoFlat. All triangles of a flat lie in one plane, to the rounding of double
  /// precision. Empty if no triangle is in a flat.
  std::vector<std::uint32_t> flatOf;
  /// No point of either mesh is farther than this from the other [m]; 0 if they are the same.
  double deviation = 0.0;
};

/// Cuts the flats of a mesh anew. A flat is a set of neighbouring triangles that lie in one plane to within the
/// rounding of the numbers that the mesh was read from. Vertices inside a flat, or inside a straight edge of
/// one, go; the others move by no more than that rounding allows, to where the planes of their flats meet.
/// Triangles of no flat stay. Closed and oriented meshes stay so. If a flat cannot be cut anew, its triangles
/// stay.
/// @param coordinateRounding  Max rounding error of a coordinate of the mesh [m]; >= 0.
/// @param onProgress          Called now and then with the fraction done; may throw to stop the work. May be
///                            empty.
/// About O(n log n), on all processors; allocates.
FlatMesh mergeFlats(const TriangleMesh& mesh, double coordinateRounding,
                    const std::function<void(double fraction)>& onProgress = {});

}  // namespace nearfit
