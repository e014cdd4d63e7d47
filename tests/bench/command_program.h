#pragma once

#include <CLI/CLI.hpp>

namespace nearfit::bench {

/// Name and help texts of a program of several commands; the footer may be empty.
struct CommandProgram {
  const char *name, *description, *footer;
  /// Adds the commands; is given what main() was.
  void (*addCommands)(CLI::App& program, int argc, char** argv);
};

/// Runs one of a program's commands: what main() returns. 0 when all went well, 2 for wrong usage, 1 for
/// anything else, with a line on stderr.
int runProgram(const CommandProgram& about, int argc, char** argv);

/// Ends the program; what was written is flushed. Static objects are not destroyed: FCL and Coal bring two versions of
/// liboctomap, whose static objects are one, and both would destroy them.
[[noreturn]] void endProgram(int code);

}  // namespace nearfit::bench
