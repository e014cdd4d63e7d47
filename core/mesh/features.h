#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/normal_cone.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// A vertex that can carry an isolated minimum: its polar cone {d : d.e <= 0 for its edge directions e} has
/// an interior, outside the material.
struct VertexFeature {
  std::uint32_t vertex;
  std::uint32_t firstNeighbour,
      neighbourCount;  ///< In MeshFeatures::neighbours: those that bound the polar cone.
  std::uint32_t
      hullCount;    ///< Of those in cyclic order around the cone: all, or none where it is too narrow to say.
  NormalCone cone;  ///< Holds the polar cone.
};

/// A convex edge, or one where the surface has no side (open, non-manifold, inconsistently oriented).
struct EdgeFeature {
  std::uint32_t edge;
  /// Corners opposite the edge in the two faces that bound its polar arc; the same one twice on an open edge.
  std::array<std::uint32_t, 2> opposite;
  NormalCone cone;
};

struct FaceFeature {
  std::uint32_t face;
  NormalCone cone;  ///< Its outward normal; half-angle 0.
};

/// The features of a mesh that can carry a minimum. The rest never does: reflex and flat edges, vertices
/// whose polar cone has no interior or lies in the material, faces without area. Where the surface has no
/// side (a rim, a non-manifold or inconsistently oriented edge and its vertices), the tangent condition alone
/// decides, and such edges and vertices are kept.
struct MeshFeatures {
  std::vector<VertexFeature> vertices;
  std::vector<EdgeFeature> edges;
  std::vector<FaceFeature> faces;
  std::vector<std::uint32_t> neighbours;
};

/// @param onProgress  Called now and then with the fraction done; may throw to stop the work. May be empty.
MeshFeatures findFeatures(const TriangleMesh& mesh,
                          const std::function<void(double fraction)>& onProgress = {});

}  // namespace nearfit
