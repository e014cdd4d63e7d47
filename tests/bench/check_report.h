#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "tests/bench/many_parts.h"

namespace nearfit::bench {

/// nearfit-cli, beside this program; empty where it is not built.
std::filesystem::path cliProgram();

/// Writes the scene to files and times `nearfit-cli report`, as a process, from these to the HTML file [s]: reading,
/// hierarchies (nothing comes from the cache), the check, pictures. Throws Error with what the program says.
/// @param repeats  Number of runs.
std::vector<double> reportTimes(const std::filesystem::path& cli, const ManyPartsScene& scene,
                                std::size_t repeats);

}  // namespace nearfit::bench
