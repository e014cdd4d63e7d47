#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/mesh/exact_surface.h"
#include "core/mesh/triangle_mesh.h"
#include "core/placing/feature.h"

namespace nearfit {

/// Features of a mesh by the exact surfaces of its faces, in the mesh's frame: their numbers do not depend on the
/// facets.
class ExactFaces {
 public:
  /// @param faces  One for each triangle of `mesh`, each index within its surfaces. Both outlive this.
  ExactFaces(const TriangleMesh& mesh, const SurfaceFaces& faces);

  /// The surface of the face that a triangle stands for.
  const ExactSurface& surfaceOf(std::uint32_t triangle) const noexcept;

  /// True if an edge belongs to the shape: the faces at it are on different surfaces, smooth to each other or not; open
  /// and non-manifold edges; and where one of two faces is on a surface of unknown shape, if it is sharp.
  bool isEdge(std::uint32_t edge) const noexcept;
  /// True for a corner of the shape: edges of more than two surfaces meet there, or end.
  /// @param edges  Of the shape, at that vertex.
  bool isCorner(std::uint32_t vertex, const std::vector<std::uint32_t>& edges) const noexcept;

  /// The whole circle, arc or straight edge that contains an edge of the shape; std::nullopt if the surfaces at it do
  /// not determine one. O(n) in it.
  std::optional<PickedFeature> edgeAt(std::uint32_t edge) const;

  /// The flat face that a triangle is of; std::nullopt if it is not of one. Like the others, it covers neighbouring
  /// faces on the same surface. O(n) in the mesh.
  std::optional<PickedFeature> plane(std::uint32_t triangle) const;
  /// The axis of the cylinder or cone, or the middle circle of the torus, that a triangle is of.
  std::optional<PickedFeature> wall(std::uint32_t triangle) const;
  /// The centre of the sphere that a triangle is of.
  std::optional<PickedFeature> sphere(std::uint32_t triangle) const;

 private:
  bool areSameFace(std::uint32_t a, std::uint32_t b, const glm::dvec3& near) const noexcept;
  bool haveSameFaces(std::uint32_t edge, std::uint32_t other) const noexcept;
  std::vector<std::uint32_t> trianglesAround(std::uint32_t triangle) const;
  std::optional<std::uint32_t> nextEdge(std::uint32_t vertex, std::uint32_t edge) const noexcept;
  std::vector<std::uint32_t> chainAlong(std::uint32_t edge) const;

  const TriangleMesh& mesh_;
  const SurfaceFaces& faces_;
  double slack_;  ///< Max distance between surfaces that are one [m].
};

}  // namespace nearfit
