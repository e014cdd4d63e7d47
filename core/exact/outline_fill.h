#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace nearfit {

/// What of the plane lies inside an outline.
enum class FillRule : std::uint8_t {
  Wound,  ///< What it winds around, in either sense: pieces may overlap.
  Odd,    ///< What it takes an odd number of crossings to leave: senses say nothing.
};

struct FilledOutline {
  std::vector<glm::dvec2> points;  ///< Those of the outline, and where parts of it cross.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Anticlockwise.
};

/// Fills an outline of closed curves with triangles.
///
/// @param points    Finite; equal ones are one.
/// @param segments  Ends by index, in the sense of the curve: with Wound the inside lies on the left. In any
///                  order; they may touch, overlap, cross and be of no length.
/// O(n log n) where crossings are few. Throws std::exception when the arithmetic gives up.
FilledOutline fillOutline(std::span<const glm::dvec2> points,
                          std::span<const std::array<std::uint32_t, 2>> segments, FillRule rule);

}  // namespace nearfit
