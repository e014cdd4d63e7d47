#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "core/base/error.h"

namespace nearfit::cli {
namespace {

struct SweepOptions {
  std::string scene, parts, poses, threshold, cutoff, out, measures, scheduler;
  std::vector<std::string> part, tolerances;
  std::string python = "python3";
  int workers = -1, draws = 1;
  unsigned long long seed = 0;
  bool isQuiet = false;
};

constexpr const char* kSweepFooter =
    "Places each of the parts at each of the poses, the others where the scene has them, and writes the "
    "least "
    "distance,\n"
    "the number of minima below the threshold and whether it overlaps another part to Parquet files in the "
    "folder.\n"
    "A sweep that was stopped goes on where it stopped, by the same command.\n"
    "Needs the Python package nearfit, which runs it: pip install '.[sweep]' in the folder of nearfit's "
    "sources.\n"
    "Example: nearfit-cli sweep pump.nearfit --parts Rotor,Cover --poses p.csv --threshold 1mm --cutoff 5mm "
    "-o "
    "out";

/// Exits with this where a package is missing; Python itself uses 1 and 2.
constexpr int kMissingPackage = 77;
/// Takes the working folder out of the path: a folder named nearfit in it would run as the package. Python has
/// PYTHONSAFEPATH for that, from 3.11 on.
constexpr const char* kSafePath =
    "import sys\n"
    "if sys.path[:1] == ['']: del sys.path[0]\n";
constexpr const char* kPackageProbe =
    "import importlib.util\n"
    "names = ('nearfit', 'numpy', 'pyarrow', 'distributed')\n"
    "sys.exit(0 if all(importlib.util.find_spec(name) for name in names) else 77)";
/// The same as -m nearfit.sweep, also for the processes that it starts.
constexpr const char* kSweepProgram =
    "import runpy\n"
    "runpy.run_module('nearfit.sweep', run_name='__main__', alter_sys=True)";

/// Pointers into the texts, with the null at their end that system calls ask for.
std::vector<char*> sweepPointers(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts)
    pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

[[noreturn]] void failStart(const std::string& python, int error) {
  throw FileError(python, "it cannot be started: " + std::system_category().message(error),
                  "install Python 3, or name its interpreter with --python");
}

/// Runs a short program of Python's, without output, and returns its exit code, -1 if a signal ended it.
int runSilently(const std::string& python, const std::string& program) {
  ::posix_spawn_file_actions_t actions{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_WRONLY, 0);
  std::vector<std::string> arguments{python, "-c", program};
  ::pid_t child = -1;
  const int error =
      ::posix_spawnp(&child, python.c_str(), &actions, nullptr, sweepPointers(arguments).data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) failStart(python, error);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) failStart(python, errno);
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Throws Error if the interpreter does not find what a sweep needs.
void checkPackages(const std::string& python) {
  const int code = runSilently(python, std::string(kSafePath) + kPackageProbe);
  if (code == 0) return;
  if (code == kMissingPackage)
    throw Error(
        python, "it has no package nearfit with what sweeps need",
        "run pip install '.[sweep]' in the folder of nearfit's sources, or name another interpreter with "
        "--python");
  throw Error(python, "it does not run a Python program", "name an interpreter of Python 3 with --python");
}

/// A length in metres by its shortest digits that Python reads as the same number. Throws UsageError.
std::string metresText(const std::string& option, const std::string& text, bool orZero) {
  const double metres = parseLength(option, text);
  checkPositive(option, metres, orZero);
  return fmt::format("{}", metres);
}

std::string toleranceText(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0)
    throw UsageError("--tolerance", fmt::format("\"{}\" is not NAME=D", oneLine(text)),
                     "name a part and a length, such as Peg=0.1mm");
  return text.substr(0, equals + 1) + metresText("--tolerance", text.substr(equals + 1), true);
}

/// Options and values are one argument each, `--name=value`: a value may begin with a dash.
std::vector<std::string> sweepArguments(const SweepOptions& options) {
  if (parseLength("--threshold", options.threshold) > parseLength("--cutoff", options.cutoff))
    throw UsageError("--threshold", "it is more than the cutoff, beyond which no minimum is looked for",
                     "give a cutoff of at least the threshold");
  if (options.parts.empty() && options.part.empty())
    throw UsageError("--parts", "no part is named", "give the parts' names: --parts A,B");
  if (options.draws != 1 && options.tolerances.empty())
    throw UsageError("--draws", "without tolerances all draws are alike", "give --tolerance NAME=D too");
  std::vector<std::string> arguments{options.python,
                                     "-c",
                                     std::string(kSafePath) + kSweepProgram,
                                     "--parts=" + options.parts,
                                     "--poses=" + options.poses,
                                     "--threshold=" + metresText("--threshold", options.threshold, true),
                                     "--cutoff=" + metresText("--cutoff", options.cutoff, false),
                                     "--out=" + options.out,
                                     fmt::format("--draws={}", options.draws),
                                     fmt::format("--seed={}", options.seed)};
  for (const std::string& name : options.part)
    arguments.push_back("--part=" + name);
  for (const std::string& tolerance : options.tolerances)
    arguments.push_back("--tolerance=" + toleranceText(tolerance));
  if (!options.measures.empty()) arguments.push_back("--measures=" + options.measures);
  if (options.workers >= 0) arguments.push_back(fmt::format("--workers={}", options.workers));
  if (!options.scheduler.empty()) arguments.push_back("--scheduler=" + options.scheduler);
  if (options.isQuiet) arguments.emplace_back("--quiet");
  arguments.insert(arguments.end(), {"--", options.scene});
  return arguments;
}

/// Becomes the sweep: what it prints, its exit code and the signals sent to it are this program's.
void runSweep(const SweepOptions& options) {
  std::vector<std::string> arguments = sweepArguments(options);
  // For the processes that the sweep starts.
  ::setenv("PYTHONSAFEPATH", "1", 1);
  checkPackages(options.python);
  flushOutput();
  std::signal(SIGPIPE, SIG_DFL);
  std::signal(SIGXFSZ, SIG_DFL);
  ::execvp(options.python.c_str(), sweepPointers(arguments).data());
  failStart(options.python, errno);
}

}  // namespace

void addSweepCommand(CLI::App& program) {
  const auto options = std::make_shared<SweepOptions>();
  CLI::App* command = program.add_subcommand(
      "sweep", "Computes distances, minima and overlap of many parts at many poses, on all processors.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("--parts", options->parts, "Parts to place, separated by commas")->type_name("A,B");
  command->add_option("--part", options->part, "One more part, whose name may have commas")
      ->allow_extra_args(false)
      ->type_name("NAME");
  command
      ->add_option("--poses", options->poses,
                   "Poses, world from part: FILE.csv, or FILE.npy with an array (k, 4, 4)")
      ->required()
      ->type_name("FILE");
  command->add_option("--threshold", options->threshold, "Count minima nearer than this [m, or with a unit]")
      ->required()
      ->type_name("D");
  command->add_option("--cutoff", options->cutoff, "Look no farther than this [m, or with a unit]")
      ->required()
      ->type_name("D");
  command->add_option("-o,--out", options->out, "Folder for the results")->required()->type_name("FOLDER");
  CLI::Option* workers = command
                             ->add_option("--workers", options->workers,
                                          "Processes; 0: one, without Dask; default: one for each processor")
                             ->check(CLI::NonNegativeNumber)
                             ->type_name("N");
  command
      ->add_option("--scheduler", options->scheduler,
                   "Dask scheduler to use instead, such as tcp://HOST:8786")
      ->excludes(workers)
      ->type_name("ADDRESS");
  command
      ->add_option("--tolerance", options->tolerances,
                   "Each draw moves this part by up to D along each axis of the world")
      ->allow_extra_args(false)
      ->type_name("NAME=D");
  command->add_option("--draws", options->draws, "Draws of the tolerances")
      ->capture_default_str()
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  command->add_option("--seed", options->seed, "Seed of the draws")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  command
      ->add_option("--measures", options->measures,
                   "Compute these only: of distance, minima and overlap, separated by commas")
      ->type_name("LIST");
  command->add_option("--python", options->python, "Interpreter of Python")
      ->capture_default_str()
      ->type_name("PROGRAM");
  command->add_flag("--quiet", options->isQuiet, "No progress on stderr");
  command->footer(kSweepFooter);
  command->callback([options] { runSweep(*options); });
}

}  // namespace nearfit::cli
