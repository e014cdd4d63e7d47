#pragma once

#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/features.h"

namespace nearfit {

/// The features of a mesh that can carry a minimum by the rule of normal spans (AcceptanceRule::NormalSpan).
///
/// By that rule the way between two points that are nearest between two triangles is a local minimum distance
/// when it lies in the span of the surface normals at both: of a face its normal, of an edge the arc between
/// the normals of its two faces, of a vertex the convex cone of the normals of its faces. Of faces and of
/// edges that is the exact condition. Of a vertex it is so only where the surface is convex: at a saddle, or
/// on a jagged fan, most directions of the span lead into a neighbouring face, and are accepted all the same.
/// The rule adds minima that are none, then, and on a closed surface misses none.
///
/// Hence: all vertices whose span has an interior are kept, those that the exact rule drops as well. Reflex
/// and flat edges are dropped by both: no triangle has its nearest point within a reflex one for a direction
/// of its arc, and a flat one's only direction is its faces'. Rims and edges of three faces or more are
/// dropped, as their normals span nothing but the faces': that much the rule misses on open meshes.
struct NormalSpanFeatures {
  /// The neighbours of a vertex are the other two corners of each of its faces, face by face.
  MeshFeatures features;
  /// One for each such pair: a direction d is in the span where d.w >= 0 for all of the vertex's walls w
  /// (unit, or zero where there are fewer walls than faces).
  std::vector<glm::dvec3> walls;
};

/// @param onProgress  Called now and then with the fraction done; may throw to stop the work. May be empty.
NormalSpanFeatures findNormalSpanFeatures(const TriangleMesh& mesh,
                                          const std::function<void(double fraction)>& onProgress = {});

}  // namespace nearfit
