#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "core/base/error.h"

namespace {

constexpr int kFailure = 1, kUsage = 2, kNegativeVerdict = 3;

constexpr const char* kFooter =
    "nearfit-cli COMMAND --help describes the options and output of a command.\n"
    "Lengths are in metres, forces in newtons, times in seconds unless said otherwise; quaternions are w, x, "
    "y, z.\n"
    "Exit code: 0 for success, 2 for wrong usage, 3 where a verdict is no (certify, verify, report, suggest, "
    "clearance --all),\n"
    "1 for any other failure, with one line on stderr.";

int report(const char* message, int exitCode) {
  nearfit::cli::printError(message);
  return exitCode;
}

int reportUsage(const CLI::App& program, const CLI::ParseError& e) {
  // For a wrong command, the parser complains of a missing one.
  const std::vector<std::string> unknown = program.remaining();
  const bool isUnknownCommand = program.get_subcommands().empty() && !unknown.empty();
  const std::string problem =
      isUnknownCommand ? fmt::format("there is no command or option \"{}\"", unknown.front()) : e.what();
  return report((problem + "; see nearfit-cli --help").c_str(), kUsage);
}

int run(int argc, char** argv) {
  CLI::App program(
      "Virtual prototyping by touch: distances, forces and placements of parts, without a window.");
  program.name("nearfit-cli");
  program.set_version_flag("--version", "nearfit-cli " NEARFIT_VERSION);
  program.require_subcommand(1);
  program.footer(kFooter);
  nearfit::cli::addInfoCommand(program);
  nearfit::cli::addCheckCommand(program);
  nearfit::cli::addLmdCommand(program);
  nearfit::cli::addSceneCommand(program);
  nearfit::cli::addPlaceCommand(program);
  nearfit::cli::addExportCommand(program);
  nearfit::cli::addClearanceCommand(program);
  nearfit::cli::addClearanceMapCommand(program);
  nearfit::cli::addPathCommand(program);
  nearfit::cli::addCertifyCommand(program);
  nearfit::cli::addVerifyCommand(program);
  nearfit::cli::addReportCommand(program);
  nearfit::cli::addSuggestCommand(program);
  nearfit::cli::addSweepCommand(program);
  nearfit::cli::addScriptCommand(program);
  nearfit::cli::addDevicesCommand(program);
  nearfit::cli::addCacheCommand(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    // Help and version end the parsing with an exception too.
    if (e.get_exit_code() != 0) return reportUsage(program, e);
    program.exit(e);
  }
  nearfit::cli::flushOutput();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // A closed pipe and a limit on the size of files are errors to report, not reasons to die silently.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const nearfit::cli::ReportedFailure&) {
    return kFailure;
  } catch (const nearfit::cli::NegativeVerdict&) {
    return kNegativeVerdict;
  } catch (const nearfit::UsageError& e) {
    return report(e.what(), kUsage);
  } catch (const std::exception& e) {
    return report(e.what(), kFailure);
  } catch (...) {
    return report("an unknown error", kFailure);
  }
}
