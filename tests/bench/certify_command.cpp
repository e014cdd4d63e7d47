#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "tests/bench/commands.h"
#include "tests/bench/pose_record.h"
#include "tests/exact/pose_certifier.h"

namespace nearfit::bench {
namespace {

struct CertifyOptions {
  std::filesystem::path scene, record;
  std::string part, pose = "proxy";
  std::size_t every = 1;
  std::string rows = "all";
};

/// Those rows of the recording that are asked for.
std::vector<RecordedPose> chosenPoses(const CertifyOptions& options) {
  std::vector<RecordedPose> poses = readRecordedPoses(options.record, options.pose, options.every);
  if (options.rows != "all") {
    const bool isReleasedWanted = options.rows == "released";
    std::erase_if(poses, [&](const RecordedPose& pose) { return pose.isReleased != isReleasedWanted; });
  }
  return poses;
}

struct Verdict {
  std::size_t meetings = 0;
  std::optional<std::size_t> firstLine;
};

Verdict certify(const Part& body, const Part& part, const std::vector<RecordedPose>& poses) {
  const RigidTransform bodyFromWorld = body.worldFromPart.inverse();
  std::vector<RigidTransform> bodyFromPart;
  bodyFromPart.reserve(poses.size());
  for (const RecordedPose& p : poses)
    bodyFromPart.push_back(bodyFromWorld * p.pose.normalized());
  const std::vector<char> meetings =
      test::PoseCertifier(body.geometry->mesh, part.geometry->mesh).meetings(bodyFromPart);
  Verdict verdict;
  verdict.meetings = static_cast<std::size_t>(std::ranges::count(meetings, 1));
  if (verdict.meetings > 0)
    verdict.firstLine =
        poses[static_cast<std::size_t>(std::ranges::find(meetings, 1) - meetings.begin())].line;
  return verdict;
}

void runCertify(const CertifyOptions& options) {
  const Scene scene = readSceneFile(options.scene);
  const Part* const part = scene.findByName(options.part);
  if (part == nullptr || !part->geometry)
    throw UsageError("--part", fmt::format("the scene has no part \"{}\"", options.part),
                     "name one of its parts");
  const std::vector<RecordedPose> poses = chosenPoses(options);
  std::size_t meetings = 0;
  std::string first;
  for (const Scene::PartPtr& body : scene.parts()) {
    if (body->id == part->id || !body->isVisible || !body->geometry) continue;
    const Verdict verdict = certify(*body, *part, poses);
    fmt::print("{}: {} of {} poses meet it{}\n", body->name, verdict.meetings, poses.size(),
               verdict.firstLine ? fmt::format(", the first in line {}", *verdict.firstLine) : "");
    std::fflush(stdout);
    if (verdict.meetings > 0 && first.empty())
      first = fmt::format("\"{}\" meets \"{}\" in line {}", part->name, body->name, *verdict.firstLine);
    meetings += verdict.meetings;
  }
  if (meetings > 0) throw Error(options.record.string(), first, "see what the servo did in the ticks before");
}

}  // namespace

void addCertifyCommand(CLI::App& program) {
  const auto options = std::make_shared<CertifyOptions>();
  CLI::App* command = program.add_subcommand(
      "certify",
      "Says by exact predicates at which poses of a recording a part meets another that is visible: touches "
      "it, cuts into it, or lies inside. Exit code 1 if there is any.");
  command->add_option("scene", options->scene, "Scene file")->required();
  command->add_option("--part", options->part, "The part that moved")->required();
  command->add_option("--record", options->record, "Recording of nearfit-cli place")->required();
  command->add_option("--pose", options->pose, "Which pose of a row: proxy or handle")->capture_default_str();
  command->add_option("--every", options->every, "Look at each so many-th row")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option(
          "--rows", options->rows,
          "all; felt: those in which nothing was released; released: those in which the part overlapped "
          "something and did not feel it")
      ->check(CLI::IsMember({"all", "felt", "released"}))
      ->capture_default_str();
  command->callback([options] { runCertify(*options); });
}

}  // namespace nearfit::bench
