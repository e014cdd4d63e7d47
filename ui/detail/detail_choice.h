#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nearfit::ui {

/// One way to draw a part.
struct DetailLevel {
  std::size_t triangles = 0;
  double cell = 0.0;  ///< How far its surface may be off, in the part's frame [m]; 0: the mesh itself.
};

/// A part that is to be drawn.
struct DetailCandidate {
  std::span<const DetailLevel> levels;  ///< The mesh itself first, then coarser and coarser.
  double pixelsPerMetre = 0.0;          ///< Where it is nearest to the eye.
  bool isSeen = true;                   ///< Not beside the picture.
};

struct DetailLimits {
  std::size_t triangles = 0;  ///< Of all parts that are seen.
  double cellPixels = 2.0;    ///< What a level may be off in the picture, where that alone is enough.
};

struct DetailChoice {
  std::vector<std::uint8_t> levels;  ///< One for each candidate.
  std::size_t triangles = 0;         ///< Of those that are seen.
  bool isExact = true;               ///< All that are seen are drawn as they are.
};

/// Draws parts as they are where all together stay within the limit. Otherwise each at the coarsest level
/// that looks the same, and while that is too much, the one that has the most triangles a level coarser. O(n
/// log n) in candidates.
DetailChoice chooseDetail(std::span<const DetailCandidate> candidates, const DetailLimits& limits);

}  // namespace nearfit::ui
