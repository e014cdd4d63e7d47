#pragma once

#include "core/mesh/triangle_mesh.h"

/// A rod in a tube, ringed by the same waves: nearly all of their features are near each other, as those of a
/// nut on its bolt are, and the rod turns freely. Both about z, closed.
namespace nearfit::test {

/// How the pair is made [m].
struct RingedPair {
  double radius = 0.5;  ///< Of the tube's bore, in the middle of a wave.
  double gap = 0.02;    ///< Between rod and bore, across the axis.
  double wave = 0.03;   ///< From the middle of a wave to its crest.
  std::uint32_t detail =
      3;  ///< 2048 faces of either face the other with 3, four times as many with each more.

  TriangleMesh tube() const;  ///< One metre high.
  TriangleMesh rod() const;   ///< Sticks out of it by a tenth of a metre at either end.
};

}  // namespace nearfit::test
