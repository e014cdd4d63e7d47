#pragma once

#include <cstddef>

namespace nearfit::ui {

/// Which minima the view draws, and how.
struct MinimaChoice {
  bool hasSegments = true, hasPoints = true, hasNormals = false;
  std::size_t most = 0;      ///< Max number drawn, the nearest ones; 0: all.
  double nearerThan = 1.0;   ///< Max distance, as a fraction of the cutoff.
  double colourRange = 0.0;  ///< Distance at the end of the colour scale [m]; 0: found from what is drawn.

  bool operator==(const MinimaChoice&) const = default;
};

}  // namespace nearfit::ui
