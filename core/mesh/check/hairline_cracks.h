#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// An open edge, and a vertex of another border near it.
struct NearBorder {
  std::uint32_t edge, vertex;
  double distance;  ///< From the edge to the vertex [m].
};

/// Open borders that run close to each other.
struct HairlineCracks {
  std::vector<NearBorder> pairs;  ///< By edge, then by vertex.
  bool isComplete = true;         ///< False if a bound on the work ended the search.
};

/// Finds cracks: each open edge with the vertices of open borders within a distance of it, but for its ends and for
/// borders that go on from these in the same direction, as round a hole. Neighbours that were cut apart are found too:
/// their borders lie on each other, at a distance of 0.
/// @param tolerance  Max distance [m]; finite, >= 0.
/// O(n log n) in open edges for ordinary meshes; a bound on the work, some seconds, ends it for others.
/// Throws Cancelled.
HairlineCracks findHairlineCracks(const TriangleMesh& mesh, double tolerance,
                                  const ProgressCallback& progress = {});

}  // namespace nearfit
