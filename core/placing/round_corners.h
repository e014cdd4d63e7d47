#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Corners of triangles, each once.
std::vector<glm::dvec3> cornersOf(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles);

/// The flat facet around a triangle; of a large one, as many triangles as suffice to locate it.
std::vector<std::uint32_t> facetOf(const TriangleMesh& mesh, std::uint32_t triangle);

/// How coarse a ring of facets may be.
struct RingRule {
  std::size_t fewestFacets;
  double widestFacet;  ///< Max angle about the axis that a facet spans [rad].
};

/// A ring that stands for something round. Eight equal facets span 45 degrees each; a bar with four flats and
/// chamfered edges has flats that span more, unless it is nearly a regular octagon.
constexpr RingRule kRoundRing{8, 0.8727};
/// A ring of flats whose axis is wanted: six equal ones span 60 degrees each.
constexpr RingRule kPrismRing{6, 1.0490};

/// Angles about an axis of the lines that corners lie on, ascending [rad]. Corners on the axis have none.
std::vector<double> linesAbout(std::span<const glm::dvec3> corners, const glm::dvec3& centre,
                               const glm::dvec3& axis);

/// True if lines about an axis, as linesAbout() gives them, go all round it, close enough to each other.
bool isRing(const std::vector<double>& lines, const RingRule& rule);
/// True if they are of an arc of a finely cut wall: at least four facets, none much wider than the others. The corners
/// of a flat face between two roundings also lie on a circle.
bool isFineArc(const std::vector<double>& lines);

}  // namespace nearfit
