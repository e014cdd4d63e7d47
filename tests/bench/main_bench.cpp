#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/error.h"
#include "tests/bench/commands.h"

namespace {

constexpr int kFailure = 1, kUsage = 2;

constexpr const char* kFooter =
    "Times are of one thread. Exit code: 0 when all went well, 1 when it did not or methods disagree (a\n"
    "benchmark of different answers is void), 2 for wrong usage.";

int run(int argc, char** argv) {
  CLI::App program("Measures Nearfit's queries and hierarchies beside those of other libraries.");
  program.name("nearfit-bench");
  program.require_subcommand(1);
  program.footer(kFooter);
  nearfit::bench::addQueryCommand(program);
  nearfit::bench::addBuildCommand(program);
  nearfit::bench::addSceneCommand(program);
  nearfit::bench::addProgramCommand(program);
  nearfit::bench::addCertifyCommand(program);
  nearfit::bench::addFeelCommand(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return program.exit(e) == 0 ? 0 : kUsage;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const nearfit::UsageError& e) {
    fmt::print(stderr, "nearfit-bench: {}\n", e.what());
    return kUsage;
  } catch (const std::exception& e) {
    fmt::print(stderr, "nearfit-bench: {}\n", e.what());
    return kFailure;
  }
}
