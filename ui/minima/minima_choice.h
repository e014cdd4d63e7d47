#pragma once

#include <cstddef>

namespace nearfit::ui {

/// Which minima the view draws, and how.
struct MinimaChoice {
  bool hasSegments = true, hasPoints = true, hasNormals = false;
  std::size_t most = 0;     ///< So many of the nearest; 0: all.
  double nearerThan = 1.0;  ///< As a share of the cutoff.

  bool operator==(const MinimaChoice&) const = default;
};

}  // namespace nearfit::ui
