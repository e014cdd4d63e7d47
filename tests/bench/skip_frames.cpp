#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/bench/skips.h"
#include "tests/support/run_process.h"

namespace nearfit::bench {
namespace {

/// Beside this program.
std::filesystem::path framesProgram() {
  return std::filesystem::canonical("/proc/self/exe").parent_path() / "nearfit-bench-frames";
}

std::vector<SkipRow> measureFrames(const SkipOptions&) {
  const std::filesystem::path program = framesProgram();
  if (!std::filesystem::exists(program)) {
    fmt::print("{:<12}not measured: {} is not there (it is built with the application)\n", "frames",
               program.filename().string());
    return {};
  }
  std::vector<std::string> command{program.string()};
  const char* display = std::getenv("DISPLAY");
  if (display == nullptr || *display == '\0') command.insert(command.begin(), {"xvfb-run", "-a"});
  const test::ProcessResult result = test::runProcess(command);
  if (result.exitCode != 0) throw Error("frames", result.err, "run " + program.string() + " by itself");
  std::istringstream in(result.out);
  return readSkipRows(in);
}

}  // namespace

std::vector<SkipEntry> frameSkips() {
  return {{"frames", "The view draws nothing where nothing has changed", measureFrames}};
}

}  // namespace nearfit::bench
