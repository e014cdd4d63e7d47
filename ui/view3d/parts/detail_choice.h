#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nearfit::ui {

/// A level of detail of a part.
struct DetailLevel {
  std::size_t triangles = 0;
  double cell = 0.0;  ///< Max deviation from the mesh, in the part's frame [m]; 0: the mesh itself.
};

/// A part to be drawn.
struct DetailCandidate {
  std::span<const DetailLevel> levels;  ///< The mesh itself first, then ever coarser.
  double pixelsPerMetre = 0.0;          ///< At the point nearest to the eye.
  bool isSeen = true;                   ///< False if outside the picture.
};

struct DetailLimits {
  std::size_t triangles = 0;  ///< Max for all seen parts together.
  double cellPixels = 2.0;    ///< Deviation allowed where that alone meets the limit [pixels].
};

struct DetailChoice {
  std::vector<std::uint8_t> levels;  ///< Index of a level for each candidate.
  std::size_t triangles = 0;         ///< Sum over the seen parts.
  bool isExact = true;               ///< All seen parts are drawn at level 0.
};

/// Chooses a level of detail for each part. All parts get level 0 if together they stay within the limit.
/// Else each gets the coarsest level within `cellPixels`; while that is too much, the part with the most
/// triangles is made one level coarser. O(n log n) in candidates.
DetailChoice chooseDetail(std::span<const DetailCandidate> candidates, const DetailLimits& limits);

}  // namespace nearfit::ui
