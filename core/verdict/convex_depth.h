#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// A translation that frees a body.
struct FreeingTranslation {
  double length = 0.0;        ///< [m]
  glm::dvec3 direction{0.0};  ///< Unit.
};

/// A convex body by its corners, and the directions of its faces and edges. In the mesh's frame.
struct ConvexBody {
  struct Face {
    glm::dvec3 normal;  ///< Unit, outward.
    std::uint32_t corner;
  };
  struct Edge {
    std::uint32_t from, to;
    std::uint32_t left, right;  ///< Its two faces, which are not in one plane.
  };
  std::vector<glm::dvec3> corners;
  std::vector<Face> faces;
  std::vector<Edge> edges;
};

/// The body that a mesh bounds, if it is convex to a few roundings of its size: closed, oriented, in one piece, and with
/// every corner behind every face. No value too if faces times corners exceed a few millions.
std::optional<ConvexBody> convexBodyOf(const TriangleMesh& mesh);

/// Least translation of `part` that frees it from `scene`, which it overlaps: the least over the normals of the faces of
/// both, and over the directions across an edge of each that the two can show to each other. Exact, to some roundings of
/// coordinates: these are the faces of the difference of the two bodies.
/// @param sceneFromPart  Unit quaternion. The direction is in the frame of `scene`.
/// No value if there are more than a few million pairs of edges, or of faces and corners. O(their number).
/// Source: D. Gregorius, The separating axis test between convex polyhedra, Game Developers Conference 2013.
std::optional<FreeingTranslation> convexDepth(const ConvexBody& scene, const ConvexBody& part,
                                              const RigidTransform& sceneFromPart);

}  // namespace nearfit
