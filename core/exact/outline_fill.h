#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace nearfit {

/// Rule that decides which points are inside an outline.
enum class FillRule : std::uint8_t {
  Wound,  ///< Nonzero winding number; parts of the outline may overlap.
  Odd,    ///< Odd number of crossings; segment directions do not matter.
};

/// Triangles that fill an outline.
struct FilledOutline {
  std::vector<glm::dvec2> points;                       ///< Points of the outline, and its crossings.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Anticlockwise, by index into `points`.
};

/// Fills an outline of closed curves with triangles.
///
/// @param points    Finite; equal points count as one.
/// @param segments  Pairs of indices into `points`, in any order. With Wound each is directed so that the
///                  inside is on its left. Segments may touch, overlap, cross and have no length.
/// The result is empty if all points lie on a line. O(n log n) for few crossings. Not for the servo thread:
/// allocates. Throws std::exception if the arithmetic fails.
FilledOutline fillOutline(std::span<const glm::dvec2> points,
                          std::span<const std::array<std::uint32_t, 2>> segments, FillRule rule);

}  // namespace nearfit
