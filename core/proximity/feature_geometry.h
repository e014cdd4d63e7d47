#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/features.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Corners and polar cones of the kept features of a mesh, numbered through: vertices, then edges, then
/// faces. Used while a hierarchy is built.
class FeatureGeometry {
 public:
  /// @param positions  Of the mesh's vertices, as the hierarchy has them; kept by reference, like the others.
  FeatureGeometry(const TriangleMesh& mesh, const MeshFeatures& features,
                  std::span<const glm::dvec3> positions);

  std::size_t size() const noexcept { return faceBase_ + features_.faces.size(); }
  std::uint32_t edgeBase() const noexcept { return edgeBase_; }
  std::uint32_t faceBase() const noexcept { return faceBase_; }

  struct Corners {
    std::array<glm::dvec3, 3> points;
    std::size_t count;
  };
  Corners corners(std::uint32_t feature) const noexcept;
  const NormalCone& cone(std::uint32_t feature) const noexcept;

  /// Largest cosine between `direction` (unit) and a direction of the feature's polar cone; never too small
  /// but by rounding.
  double support(std::uint32_t feature, const glm::dvec3& direction) const noexcept;

  /// A vertex with more walls than this has no rays: its cone says enough.
  static constexpr std::size_t kMaxRays = 32;

  /// The unit rays that a polar cone is spanned by.
  struct Rays {
    std::array<glm::dvec3, kMaxRays> rays;
    std::size_t count = 0;
    /// A unit direction of the polar cone is a sum of rays with weights >= 0 that add up to at least 1 and at
    /// most this; infinity when the rays do not span it.
    double stretch;
  };
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
