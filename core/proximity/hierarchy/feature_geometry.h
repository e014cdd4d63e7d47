#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/features.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Corners and polar cones of the kept features of a mesh, numbered consecutively: vertices, then edges, then
/// faces. Used to build a hierarchy.
class FeatureGeometry {
 public:
  /// @param positions  The mesh's vertices in the hierarchy's frame. All arguments are kept by reference.
  FeatureGeometry(const TriangleMesh& mesh, const MeshFeatures& features,
                  std::span<const glm::dvec3> positions);

  std::size_t size() const noexcept { return faceBase_ + features_.faces.size(); }  ///< Number of features.
  std::uint32_t edgeBase() const noexcept { return edgeBase_; }  ///< Number of the first edge.
  std::uint32_t faceBase() const noexcept { return faceBase_; }  ///< Number of the first face.

  struct Corners {
    std::array<glm::dvec3, 3> points;
    std::size_t count;
  };
  Corners corners(std::uint32_t feature) const noexcept;
  const NormalCone& cone(std::uint32_t feature) const noexcept;

  /// Upper bound, but for rounding, on the cosine between `direction` (unit) and the directions of the
  /// feature's polar cone.
  double support(std::uint32_t feature, const glm::dvec3& direction) const noexcept;

  /// A vertex with more walls than this gets no rays; its cone bounds it well enough.
  static constexpr std::size_t kMaxRays = 32;

  /// Unit rays that span a polar cone.
  struct Rays {
    std::array<glm::dvec3, kMaxRays> rays;
    std::size_t count = 0;
    /// A unit direction of the polar cone is a sum of rays with weights >= 0 that total between 1 and this;
    /// infinity if the rays do not span the cone.
    double stretch;
  };
  /// Writes the rays of a feature, or its cone's axis alone if no rays span the polar cone.
  void rays(std::uint32_t feature, Rays& out) const noexcept;

 private:
  bool raysOfVertex(const VertexFeature& v, Rays& out) const noexcept;
  void raysOfEdge(const EdgeFeature& e, Rays& out) const noexcept;
  double vertexSupport(const VertexFeature& v, const glm::dvec3& w) const noexcept;
  double edgeSupport(const EdgeFeature& e, const glm::dvec3& w) const noexcept;

  const TriangleMesh& mesh_;
  const MeshFeatures& features_;
  std::span<const glm::dvec3> x_;
  std::uint32_t edgeBase_, faceBase_;
};

}  // namespace nearfit
