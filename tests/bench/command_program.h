#pragma once

#include <CLI/CLI.hpp>

namespace nearfit::bench {

/// Runs one of a program's commands: what main() returns. 0 when all went well, 2 for wrong usage, 1 for
/// anything else, with a line on stderr.
int runCommand(CLI::App& program, int argc, char** argv);

}  // namespace nearfit::bench
