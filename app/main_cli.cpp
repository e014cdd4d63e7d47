#include <csignal>
#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "core/error.h"

namespace {

constexpr int kFailure = 1, kUsage = 2;

/// One line for stderr, whatever the message holds.
int report(const std::string& message, int exitCode) {
  fmt::print(stderr, "nearfit-cli: {}\n", nearfit::cli::oneLine(message));
  return exitCode;
}

int run(int argc, char** argv) {
  CLI::App program(
      "Virtual prototyping by touch: distances, forces and placements of parts, without a window.");
  program.name("nearfit-cli");
  program.set_version_flag("--version", "nearfit-cli " NEARFIT_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Exit code: 0 when all went well, 2 for wrong usage, 1 for anything else, with one line on stderr.\n"
      "Lengths are in metres, angles in radians, forces in newtons; quaternions are w, x, y, z.");
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    // Help and version end the parsing by an exception too.
    if (e.get_exit_code() != 0) return report(fmt::format("{}; see nearfit-cli --help", e.what()), kUsage);
    program.exit(e);
  }
  nearfit::cli::flushOutput();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // A reader that has gone is an error to report, not a reason to die without a word.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const nearfit::UsageError& e) {
    return report(e.what(), kUsage);
  } catch (const std::exception& e) {
    return report(e.what(), kFailure);
  } catch (...) {
    return report("an unknown error", kFailure);
  }
}
