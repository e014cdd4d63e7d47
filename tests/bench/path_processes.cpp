#include "tests/bench/path_processes.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/path/path_file.h"
#include "tests/bench/bench_clock.h"
#include "tests/bench/scene_files.h"
#include "tests/support/run_process.h"
#include "tests/support/scoped_variable.h"

namespace nearfit::bench {
namespace {

double timeOf(const std::vector<std::string>& command) {
  const double start = secondsBy(BenchClock::Wall);
  const test::ProcessResult result = test::runProcess(command);
  const double seconds = secondsBy(BenchClock::Wall) - start;
  if (result.exitCode != 0)
    throw Error(fmt::format("nearfit-cli {}", command.at(1)), result.out + result.err,
                "run it by hand on such a path");
  return seconds;
}

}  // namespace

PathFiles writePathFiles(const std::filesystem::path& cli, const Scene& scene, const AssemblyPath& path,
                         double separation, const test::TemporaryFolder& folder) {
  PathFiles files{writeWithMeshes(scene, folder), folder.path() / "path.nfpath",
                  folder.path() / "path.nfcert"};
  writePathFile(path, files.path);
  files.certifySeconds =
      timeOf({cli.string(), "certify", files.path.string(), files.scene.string(), "-o",
              files.certificate.string(), "--separation", fmt::format("{:.17g}", separation)});
  return files;
}

PathProcessTimes timePathProcesses(const std::filesystem::path& cli, const Scene& scene,
                                   const AssemblyPath& path, double separation) {
  const test::ScopedVariable noCache("NEARFIT_CACHE", "off");
  const test::TemporaryFolder folder;
  const PathFiles files = writePathFiles(cli, scene, path, separation, folder);
  return {files.certifySeconds, timeOf({cli.string(), "verify", files.certificate.string(),
                                        files.scene.string(), files.path.string()})};
}

}  // namespace nearfit::bench
