#pragma once

namespace CLI {
class App;
}

/// Each function adds one subcommand with its help to `program`; the subcommand runs while the
/// arguments are parsed. Results go to stdout. Failures are thrown: UsageError (exit code 2),
/// NegativeVerdict (exit code 3) or anything else (exit code 1).
namespace nearfit::cli {

void addInfoCommand(CLI::App& program);
void addCheckCommand(CLI::App& program);
void addLmdCommand(CLI::App& program);
void addSceneCommand(CLI::App& program);
void addPlaceCommand(CLI::App& program);
void addExportCommand(CLI::App& program);
void addClearanceCommand(CLI::App& program);
void addClearanceMapCommand(CLI::App& program);
void addPathCommand(CLI::App& program);
void addCertifyCommand(CLI::App& program);
void addVerifyCommand(CLI::App& program);
void addReportCommand(CLI::App& program);
void addSuggestCommand(CLI::App& program);
void addScriptCommand(CLI::App& program);
void addCacheCommand(CLI::App& program);
void addDevicesCommand(CLI::App& program);
void addSweepCommand(CLI::App& program);

}  // namespace nearfit::cli
