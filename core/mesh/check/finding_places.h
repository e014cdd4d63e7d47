#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/check/mesh_check.h"

namespace nearfit {

/// Sorts the defects of one kind by place: defects that share a vertex are in one. O(n) about.
class FindingPlaces {
 public:
  /// @param mesh  Kept by reference.
  explicit FindingPlaces(const TriangleMesh& mesh) : mesh_(mesh) {}

  /// One defect.
  struct Defect {
    std::vector<std::uint32_t> vertices;  ///< Where it is; at least one.
    std::vector<std::uint32_t> edges, triangles;
    FindingSeverity severity = FindingSeverity::Note;
    double length = 0.0;
    std::uint64_t count = 1;
  };
  void add(const Defect& defect);
  void addEdge(std::uint32_t edge, FindingSeverity severity);

  /// Appends what was added to the check: a finding for each place, the largest first. A finding has the max length and
  /// the worst severity of its defects.
  /// @param isCut  See FindingTotal.
  void finish(MeshCheck& check, FindingKind kind, bool isCut = false) const;

 private:
  struct Kept {
    std::uint32_t firstVertex, vertexCount, firstEdge, edgeCount, firstTriangle, triangleCount;
    FindingSeverity severity;
    double length;
    std::uint64_t count;
  };
  std::vector<std::uint32_t> placesOfDefects() const;
  void grow(MeshFinding& finding, const Kept& defect) const;

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> vertices_, edges_, triangles_;  ///< Places of the defects, one after the other.
  std::vector<Kept> defects_;
};

}  // namespace nearfit
