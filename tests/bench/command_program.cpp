#include "tests/bench/command_program.h"

#include <cstdio>
#include <exception>

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit::bench {
namespace {

constexpr int kFailure = 1, kUsage = 2;

int parseAndRun(CLI::App& program, int argc, char** argv) {
  try {
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& e) {
    return program.exit(e) == 0 ? 0 : kUsage;
  }
}

}  // namespace

int runProgram(const CommandProgram& about, int argc, char** argv) {
  try {
    CLI::App program(about.description, about.name);
    program.footer(about.footer);
    program.require_subcommand(1);
    about.addCommands(program, argc, argv);
    return parseAndRun(program, argc, argv);
  } catch (const UsageError& e) {
    fmt::print(stderr, "{}: {}\n", about.name, e.what());
    return kUsage;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: {}\n", about.name, e.what());
    return kFailure;
  }
}

}  // namespace nearfit::bench
