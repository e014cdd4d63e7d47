#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/check/mesh_repair.h"

namespace nearfit {

/// A mesh under repair.
struct MeshInRepair {
  std::vector<glm::dvec3> vertices;  ///< [m]
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> originOf;  ///< See RepairedMesh.

  explicit MeshInRepair(const TriangleMesh& mesh);
  /// The mesh as it is now, with its adjacency. O(n log n).
  TriangleMesh built() const { return {vertices, triangles}; }
  /// Replaces corners by others, and removes faces that then use a vertex twice; returns their number.
  std::uint64_t replaceCorners(const std::vector<std::uint32_t>& by);
  /// Removes the triangles that are marked; returns their number.
  std::uint64_t remove(const std::vector<bool>& isRemoved);
  /// Replaces the triangles by fragments of them.
  /// @param origins  By new triangle: the present one that it is a fragment of.
  void replaceByFragments(std::vector<Triangle> fragments, const std::vector<std::uint32_t>& origins);
};

// The repairs; see RepairKind. Each changes the mesh and says what it did.

RepairStep weldVertices(MeshInRepair& mesh, double tolerance);
RepairStep stitchBorders(MeshInRepair& mesh, double tolerance);
RepairStep cleanFaces(MeshInRepair& mesh);
RepairStep orientFaces(MeshInRepair& mesh);
/// Throws Cancelled.
RepairStep fillHoles(MeshInRepair& mesh, double size, const ProgressCallback& progress);
RepairStep dropShells(MeshInRepair& mesh, double size);

}  // namespace nearfit
