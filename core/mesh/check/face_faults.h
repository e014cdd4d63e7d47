#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// A face whose smallest height is at most this fraction of the mesh's diagonal has no area: some thousand roundings of
/// double precision, a ten thousandth of those of a file in single precision.
constexpr double kNoHeight = 1e-12;

/// Triangles of a mesh without area, in ascending order. O(n).
std::vector<std::uint32_t> facesWithoutArea(const TriangleMesh& mesh);

/// Faces that have the same three corners.
struct FaceCopies {
  std::vector<std::uint32_t> faces;  ///< Two or more, ascending.
  /// The ones of `faces` to remove so that one surface is left: all of one sense that are too many, and of two of
  /// opposite senses the one that disagrees with its neighbours, or both if each agrees with others, as a wall within
  /// a solid.
  std::vector<std::uint32_t> surplus;
  bool areOpposite = false;  ///< They face both ways.
};

/// Finds faces with the same corners, whatever their sense. In the order of their first faces. O(n) about.
std::vector<FaceCopies> copiesOfFaces(const TriangleMesh& mesh);

}  // namespace nearfit
