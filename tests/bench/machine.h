#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace nearfit::bench {

/// What results depend on besides the program: processor and its vector instructions, memory, kernel,
/// compiler and flags, revision of the sources, peers, command, date, load. Names and values, one line each.
std::vector<std::pair<std::string, std::string>> machineDescription();

/// The description as comment lines of a CSV file, each with its "# " and line end. If other programs are at
/// work, the first line says so and how much ("# busy machine: ...").
/// @param file  Where the results are to go; empty for the screen. Throws Error if it lies among the sources
///              and the results could not be repeated (run_rules.h).
std::string machineComment(const std::filesystem::path& file = {});

/// The load averages of the last 1, 5 and 15 minutes.
std::string loadAverages();

}  // namespace nearfit::bench
