#include "tests/bench/check_report.h"

#include <string>
#include <system_error>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "tests/bench/bench_clock.h"
#include "tests/support/mesh_text.h"
#include "tests/support/part_geometries.h"
#include "tests/support/run_process.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench {
namespace {

/// Exit code of nearfit-cli where parts clash: the report is written all the same.
constexpr int kClashExit = 3;

std::filesystem::path writeManyParts(const ManyPartsScene& scene, const test::TemporaryFolder& folder) {
  std::vector<PartGeometryPtr> geometries;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const std::string name = fmt::format("mesh_{}.obj", i + 1);
    geometries.push_back(loadPartGeometry(folder.write(name, test::objText(scene.meshes[i])), 1.0));
  }
  Scene placed;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    placed.add(test::partOf(geometries[scene.parts[i].mesh], fmt::format("part {}", i + 1).c_str(),
                            scene.parts[i].worldFromPart));
  const std::filesystem::path file = folder.path() / "scene.nearfit";
  writeSceneFile(placed, file);
  return file;
}

}  // namespace

std::filesystem::path cliProgram() {
  const std::filesystem::path program =
      std::filesystem::canonical("/proc/self/exe").parent_path() / "nearfit-cli";
  std::error_code error;
  return std::filesystem::exists(program, error) ? program : std::filesystem::path();
}

std::vector<double> reportTimes(const std::filesystem::path& cli, const ManyPartsScene& scene,
                                std::size_t repeats) {
  const test::ScopedVariable noCache("NEARFIT_CACHE", "off");
  const test::TemporaryFolder folder;
  const std::filesystem::path file = writeManyParts(scene, folder), report = folder.path() / "report.html";
  const std::vector<std::string> command{
      cli.string(), "report",       file.string(), "--threshold", fmt::format("{:.17g}", scene.threshold),
      "-o",         report.string()};
  std::vector<double> seconds;
  for (std::size_t i = 0; i < repeats; ++i) {
    const double start = secondsBy(BenchClock::Wall);
    const test::ProcessResult result = test::runProcess(command);
    seconds.push_back(secondsBy(BenchClock::Wall) - start);
    if ((result.exitCode != 0 && result.exitCode != kClashExit) || !std::filesystem::exists(report))
      throw Error("nearfit-cli report", result.err, "run it by hand on such a scene");
    std::filesystem::remove(report);
  }
  return seconds;
}

}  // namespace nearfit::bench
