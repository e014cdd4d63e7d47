#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/bench/feel_report.h"
#include "tests/bench/pressed_walk.h"

namespace nearfit::bench {

/// Two solids with curved faces in contact. The meshes come nearer to the solids the finer they are.
struct CurvedScene {
  std::string name, description;
  /// @param fineness  Edges are so many times shorter than those of the coarsest.
  std::function<PressedParts(std::uint32_t fineness)> make;
};

/// Sphere in a bowl, wheels with rounded teeth in mesh, nut on a rounded thread.
std::vector<CurvedScene> curvedScenes();

/// Edges 1, 2 and 4 times shorter: times, and their ratio to those of the coarsest.
std::vector<FeelRow> curvedRows(const CurvedScene& scene, std::size_t ticks);

}  // namespace nearfit::bench
