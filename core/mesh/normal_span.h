#pragma once

#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/features.h"

namespace nearfit {

/// The features of a mesh that can carry a minimum under the normal-span rule (AcceptanceRule::NormalSpan).
///
/// By this rule, the segment between the nearest points of two triangles is a local minimum distance if it
/// lies in the span of the surface normals at both ends. The span is the normal of a face, the arc between
/// the normals of an edge's two faces, or the convex cone of the normals of a vertex's faces. For faces and
/// edges this is the exact condition. For vertices it is exact only where the surface is convex: at a saddle,
/// or on a jagged fan, most directions of the span lead into a neighbouring face but are accepted. So the
/// rule adds false minima, and on a closed surface misses none.
///
/// All vertices whose span has an interior are kept, including those that the exact rule drops. Both rules
/// drop reflex and flat edges: no triangle has its nearest point within a reflex edge for a direction of its
/// arc, and a flat edge's only direction is that of its faces. Rims and edges with three or more faces are
/// dropped, since their normals span nothing but the faces'; on open meshes the rule misses their minima.
struct NormalSpanFeatures {
  /// The neighbours of a vertex are the other two corners of each of its faces, face by face.
  MeshFeatures features;
  /// One per such pair of neighbours. A direction d is in the span if d.w >= 0 for all walls w of the vertex.
  /// Unit; zero if there are fewer walls than faces.
  std::vector<glm::dvec3> walls;
};

/// Finds the features for the normal-span rule. Only `nearfit-cli lmd --rule normal-span` and benchmarks use it.
/// @param onProgress  Called now and then with the fraction done; may throw to stop the work. May be empty.
NormalSpanFeatures findNormalSpanFeatures(const TriangleMesh& mesh,
                                          const std::function<void(double fraction)>& onProgress = {});

}  // namespace nearfit
