#pragma once

#include <string>
#include <utility>
#include <vector>

namespace nearfit::bench {

/// What results depend on besides the program: processor and its vector instructions, memory, kernel,
/// compiler and flags, revision of the sources, peers, date, load. Names and values, one line each.
std::vector<std::pair<std::string, std::string>> machineDescription();

/// The description as comment lines of a CSV file, each with its "# " and line end.
std::string machineComment();

/// The load averages of the last 1, 5 and 15 minutes.
std::string loadAverages();

}  // namespace nearfit::bench
