#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Edges sharper than this are drawn as lines and get split normals [rad]. Facets of finely tessellated cylinders
/// stay below it.
constexpr double kSharpAngle = std::numbers::pi / 6.0;

/// A mesh for drawing, its vertices split along sharp edges so that each has one normal.
struct ShadedMesh {
  std::vector<std::uint32_t> vertices;  ///< For each vertex, that of the mesh at its place.
  /// Mean direction of the faces around each vertex, of length 1; 0 if they have no area or cancel out.
  std::vector<glm::vec3> normals;
  std::vector<Triangle> triangles;  ///< In the mesh's order, with indices into `vertices`.
  /// Edges of the mesh that are sharp, open, or have more than two faces; ascending.
  std::vector<std::uint32_t> sharpEdges;
};

/// Splits a mesh along its sharp edges. O(n log n), however many faces a vertex or an edge has.
/// @param sharpAngle  An edge whose faces' normals differ by this or more is sharp [rad].
/// @param tolerance   Max distance of corners from their true places [m]; >= 0, see flatTolerance(). Triangles so
///                    thin that it may turn them (kReliableHeight) face as the reliable ones beside them.
ShadedMesh shadedMesh(const TriangleMesh& mesh, double sharpAngle, double tolerance = 0.0);

}  // namespace nearfit
