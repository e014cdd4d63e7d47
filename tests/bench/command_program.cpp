#include "tests/bench/command_program.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/bench/run_rules.h"

namespace nearfit::bench {
namespace {

constexpr int kFailure = 1, kUsage = 2;

/// As typed, words with blanks in quotation marks.
std::string commandLine(int argc, char** argv) {
  std::string line;
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    const bool hasBlank = word.find(' ') != std::string::npos;
    line += (line.empty() ? "" : " ") + (hasBlank ? "\"" + word + "\"" : word);
  }
  return line;
}

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
    program.fallthrough();
    runRules().command = commandLine(argc, argv);
    program.add_flag("--allow-busy", runRules().allowsBusy,
                     "Keep results among the sources though other programs are at work; they say so");
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

void endProgram(int code) {
  std::cout.flush();
  std::fflush(nullptr);
  std::_Exit(code);
}

}  // namespace nearfit::bench
