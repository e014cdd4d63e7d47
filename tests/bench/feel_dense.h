#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/feel_report.h"
#include "tests/bench/pressed_walk.h"

namespace nearfit::bench {

/// Two solids of flat faces in contact, which a hand presses and moves. Their faces can be cut as finely as
/// wanted: the solids, and so what is felt, stay the same.
struct DenseScene {
  std::string name, description;
  TriangleMesh scene, part;
  PressingMotion motion;
  std::uint32_t finest = 64;  ///< Edges are cut into at most so many pieces.
};

/// Block on a plate, edge on a flat, peg in its bore, chamfered peg that goes into its hole.
std::vector<DenseScene> denseScenes();

/// Walks the hand's motion. @param pieces  Of each edge; a power of two.   @param isUneven  Cut further at random
/// places.
PressedWalk walkDense(const DenseScene& scene, std::uint32_t pieces, bool isUneven, std::size_t ticks);

/// Each fineness beside the coarsest: times and their ratio, and how far pose and wrench are off.
std::vector<FeelRow> denseRows(const DenseScene& scene, std::size_t ticks);

}  // namespace nearfit::bench
