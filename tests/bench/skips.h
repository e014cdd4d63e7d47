#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/hand_path.h"
#include "tests/bench/skip_row.h"

namespace nearfit::bench {

struct SkipOptions {
  HandPathOptions path;          ///< For queries and ticks.
  RunOptions run;                ///< Rounds count for those alone.
  std::size_t repeats = 3;       ///< Times to build, load or open.
  std::size_t farParts = 1000;   ///< For parts out of reach.
  std::size_t instances = 100;   ///< Parts that share a mesh.
  std::size_t sceneParts = 100;  ///< Of the scene of which few parts come near.
};

/// Work that Nearfit does not do. To add one, add a row to one of the functions below.
struct SkipEntry {
  std::string name, description;
  std::function<std::vector<SkipRow>(const SkipOptions&)> measure;
};

std::vector<SkipEntry> querySkips();
std::vector<SkipEntry> tickSkips();
std::vector<SkipEntry> loadSkips();
/// Runs nearfit-bench-frames, which stands beside this program where it is built with the application; with a
/// virtual display (xvfb-run) where there is none.
std::vector<SkipEntry> frameSkips();

std::vector<SkipEntry> allSkips();

}  // namespace nearfit::bench
