#include "tests/bench/check_report.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "core/path/path_certifier.h"
#include "tests/bench/bench_clock.h"
#include "tests/bench/path_processes.h"
#include "tests/bench/scene_files.h"
#include "tests/support/run_process.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench {
namespace {

/// Exit code of nearfit-cli where parts clash: the report is written all the same.
constexpr int kClashExit = 3;
/// Between two poses [s].
constexpr double kReportPathPeriod = 1e-3;

/// Up along z by a share of the height; turned about z through the centre once the part is on its way.
RigidTransform liftedBy(double share, double height, const RigidTransform& start, const glm::dvec3& centre) {
  constexpr double kTurnFrom = 0.5;
  const double angle = 2.0 * std::numbers::pi * std::max(0.0, share - kTurnFrom);
  const glm::dquat rotation =
      glm::normalize(glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0)) * start.rotation);
  const glm::dvec3 middle = start.applyToPoint(centre) + glm::dvec3(0.0, 0.0, share * height);
  return {rotation, middle - rotation * centre};
}

}  // namespace

std::filesystem::path cliProgram() {
  const std::filesystem::path program =
      std::filesystem::canonical("/proc/self/exe").parent_path() / "nearfit-cli";
  std::error_code error;
  return std::filesystem::exists(program, error) ? program : std::filesystem::path();
}

LiftedPart liftOut(const ManyPartsScene& many, std::size_t poses) {
  constexpr std::size_t kMaxTried = 20;
  Scene scene = sceneOf(many);
  for (std::size_t tried = 0; tried < std::min(kMaxTried, many.parts.size()); ++tried) {
    const Part part = *scene.parts()[many.parts.size() - 1 - tried];
    scene.setMovingPart(part.id);
    AssemblyPath path = pathFrame(scene);
    for (std::size_t i = 0; i < poses; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(poses - 1);
      path.poses.push_back({kReportPathPeriod * static_cast<double>(i),
                            liftedBy(share, many.diagonal, part.worldFromPart, path.centre)});
    }
    const double separation = defaultSeparation(scene, path);
    if (PathCertifier(scene, path, separation).prove(path).isFree())
      return {std::move(scene), std::move(path), separation};
  }
  throw Error(many.name, "none of its last parts can be lifted out", "time reports of another scene");
}

std::vector<double> reportTimes(const std::filesystem::path& cli, const LiftedPart& lifted, double threshold,
                                std::size_t repeats) {
  const test::ScopedVariable noCache("NEARFIT_CACHE", "off");
  const test::TemporaryFolder folder;
  const std::filesystem::path report = folder.path() / "report.html";
  const PathFiles files = writePathFiles(cli, lifted.scene, lifted.path, lifted.separation, folder);
  const std::vector<std::string> command{cli.string(),
                                         "report",
                                         files.scene.string(),
                                         "--path",
                                         files.path.string(),
                                         "--certificate",
                                         files.certificate.string(),
                                         "--threshold",
                                         fmt::format("{:.17g}", threshold),
                                         "-o",
                                         report.string()};
  std::vector<double> seconds;
  for (std::size_t i = 0; i < repeats; ++i) {
    const double start = secondsBy(BenchClock::Wall);
    const test::ProcessResult result = test::runProcess(command);
    seconds.push_back(secondsBy(BenchClock::Wall) - start);
    if ((result.exitCode != 0 && result.exitCode != kClashExit) || !std::filesystem::exists(report))
      throw Error("nearfit-cli report", result.out + result.err, "run it by hand on such a scene");
    std::filesystem::remove(report);
  }
  return seconds;
}

}  // namespace nearfit::bench
