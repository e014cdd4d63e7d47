#include "tests/bench/occ_program.h"

#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/support/run_process.h"

namespace nearfit::bench {
namespace {

/// What a run of the program printed. Throws Error if it failed.
std::string outputOf(const std::vector<std::string>& command) {
  const test::ProcessResult result = test::runProcess(command);
  if (result.exitCode == 0) return result.out;
  std::string line;
  for (const std::string& word : command)
    line += (line.empty() ? "" : " ") + word;
  throw Error("nearfit-bench-occ",
              result.err.empty() ? fmt::format("it ended by {}", result.exitCode) : result.err,
              "run " + line);
}

}  // namespace

std::filesystem::path occProgram() {
  const std::filesystem::path program =
      std::filesystem::canonical("/proc/self/exe").parent_path() / "nearfit-bench-occ";
  std::error_code error;
  return std::filesystem::exists(program, error) ? program : std::filesystem::path();
}

OccRun runOcc(const std::filesystem::path& program, const std::filesystem::path& file) {
  return readOccRun(outputOf({program.string(), "read", file.string()}));
}

void makeAssembly(const std::filesystem::path& program, const AssemblySize& size,
                  const std::filesystem::path& file) {
  outputOf({program.string(), "make", file.string(), "--instances", fmt::format("{}", size.instances),
            "--shapes", fmt::format("{}", size.shapes), "--triangles", fmt::format("{}", size.triangles)});
}

}  // namespace nearfit::bench
