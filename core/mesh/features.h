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
/// an interior outside the material.
struct VertexFeature {
  std::uint32_t vertex;
  /// Range in MeshFeatures::neighbours: the vertices whose edges bound the polar cone.
  std::uint32_t firstNeighbour, neighbourCount;
  /// How many of them are in cyclic order around the cone: all, or 0 if the cone is too narrow to tell.
  std::uint32_t hullCount;
  NormalCone cone;  ///< Encloses the polar cone.
};

/// A convex edge, or an edge where the surface has no side (open, non-manifold or inconsistently oriented).
struct EdgeFeature {
  std::uint32_t edge;
  /// Corners opposite the edge in the two faces that bound its polar arc; the same corner twice
  /// on an open edge.
  std::array<std::uint32_t, 2> opposite;
  NormalCone cone;
};

/// A face with an area.
struct FaceFeature {
  std::uint32_t face;
  NormalCone cone;  ///< Axis: the outward normal. Half-angle 0.
};

/// The features of a mesh that can carry a minimum. All others cannot: reflex and flat edges, vertices whose
/// polar cone has no interior or lies in the material, faces without area. Where the surface has no side (at
/// a rim, a non-manifold or inconsistently oriented edge, and their vertices), only the tangent condition
/// decides, and the feature is kept. Frame and units are the mesh's.
struct MeshFeatures {
  std::vector<VertexFeature> vertices;
  std::vector<EdgeFeature> edges;
  std::vector<FaceFeature> faces;
  /// Vertex indices; see VertexFeature::firstNeighbour.
  std::vector<std::uint32_t> neighbours;
};

/// Finds the features that can carry a minimum. About O(n); allocates.
/// @param onProgress  Called now and then with the fraction done; may throw to stop the work. May be empty.
/// @param flatOf      By triangle: the flat that it is in, or kNoFlat (flat_mesh.h). Edges inside a flat carry
///                    none. Empty: every edge is judged by its angle.
MeshFeatures findFeatures(const TriangleMesh& mesh,
                          const std::function<void(double fraction)>& onProgress = {},
                          std::span<const std::uint32_t> flatOf = {});

}  // namespace nearfit
