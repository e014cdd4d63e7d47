#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "app/cli/scene_part.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/sha256.h"
#include "core/path/certificate.h"
#include "core/path/path_file.h"
#include "core/path/path_search.h"
#include "core/scene/drawn_pose.h"
#include "core/scene/scene_file.h"
#include "core/text/json_text.h"

namespace nearfit::cli {
namespace {

struct SuggestOptions {
  std::string scene, part, group, to, out, certificate;
  bool isToDrawn = false, isOut = false, isJson = false, isWithoutTurns = false;
  std::optional<double> separation;
  double seconds = 30.0;
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> motions;
};

constexpr const char* kSuggestFooter =
    "Exactly one of --to-drawn, --out and --to. --to-drawn: where the part's CAD document places it, or "
    "where\n"
    "the coordinates of its mesh file are; of a group, the part that leads it. --out: until the box of what\n"
    "moves is clear of the box of all others. Joints do not hold what moves.\n"
    "The path keeps the separation everywhere between its poses, which is proven; --certificate writes the "
    "proof,\n"
    "as certify does, for verify. Exit code 3 if none was found, which does not mean that there is none; "
    "what was tried is "
    "printed.\n"
    "The same seed gives the same path if --motions ends the search and not its time.\n"
    "Example: nearfit-cli suggest fit.nearfit --part Peg --out --seconds 60 -o out.nfpath";

void checkSuggestOptions(const SuggestOptions& options) {
  const int goals = (options.isToDrawn ? 1 : 0) + (options.isOut ? 1 : 0) + (options.to.empty() ? 0 : 1);
  if (goals != 1)
    throw UsageError("suggest", goals == 0 ? "it is not said where to" : "it is said more than once where to",
                     "give one of --to-drawn, --out and --to");
  checkPositive("--seconds", options.seconds);
  if (options.separation) checkPositive("--separation", *options.separation);
}

/// Throws UsageError if an output would replace an input or the other output.
void checkSuggestTargets(const SuggestOptions& options, const Scene& scene) {
  std::vector<std::filesystem::path> inputs = partFiles(scene);
  inputs.emplace_back(options.scene);
  checkTarget(options.out, inputs);
  if (options.certificate.empty()) return;
  checkTarget(options.certificate, inputs);
  if (isSameTarget(options.certificate, options.out))
    throw UsageError("--certificate", "it is where the path goes", "name another file");
}

PathGoal goalOf(const SuggestOptions& options, const Scene& scene) {
  if (options.isOut) return {};
  if (!options.to.empty()) return {parsePose("--to", options.to)};
  return {drawnPose(scene, *scene.movingPart())};
}

nlohmann::ordered_json suggestJson(const Scene& scene, const PathGoal& goal, const PathSearchResult& result) {
  nlohmann::ordered_json json;
  json["found"] = result.end == PathSearchEnd::Found;
  json["separation"] = result.separation;
  json["seconds"] = result.seconds;
  if (result.end == PathSearchEnd::Found) {
    json["poses"] = result.path.poses.size();
    return json;
  }
  json["directions"] = result.directions;
  json["motions"] = result.motions;
  json["reached_poses"] = result.poses;
  json["farthest"] = result.farthest;
  if (goal.pose && result.end == PathSearchEnd::NotFound) json["left"] = result.nearest;
  if (result.blocked) {
    json["blocked_at"] = result.end == PathSearchEnd::StartNotFree ? "start" : "goal";
    json["part"] = scene.get(result.blocked->part).name;
    json["other"] = scene.get(result.blocked->other).name;
    json["distance"] = result.blocked->distance;
  }
  return json;
}

void runSuggest(const SuggestOptions& options) {
  checkSuggestOptions(options);
  // Of the file as it was before it is read, so that a change meanwhile is found.
  const std::string sceneSha256 = options.certificate.empty() ? std::string() : sha256OfFile(options.scene);
  const Scene scene = withInHand(readSceneFile(options.scene), options.part, options.group, options.scene);
  checkSuggestTargets(options, scene);
  const PathGoal goal = goalOf(options, scene);
  PathSearchOptions search;
  search.separation = options.separation.value_or(0.0);
  search.seconds = options.seconds;
  search.seed = options.seed;
  if (options.motions) search.maxMotions = *options.motions;
  search.mayTurn = !options.isWithoutTurns;
  const PathSearchResult result = searchPath(scene, goal, search);
  if (result.end == PathSearchEnd::Found) {
    writePathFile(result.path, options.out);
    if (!options.certificate.empty())
      atomicWrite(options.certificate,
                  certificateText(certificateOf(scene, result.path, result.proof, sceneSha256)));
  }
  printCacheWarnings();
  const auto length = [](double metres) { return fmt::format("{:.6g} m", metres); };
  if (options.isJson) {
    print(prettyJson(suggestJson(scene, goal, result)));
  } else {
    print(oneLine(describePathSearch(scene, goal, result, length)) + "\n");
  }
  if (result.end != PathSearchEnd::Found) throw NegativeVerdict();
}

}  // namespace

void addSuggestCommand(CLI::App& program) {
  const auto options = std::make_shared<SuggestOptions>();
  CLI::App* command = program.add_subcommand(
      "suggest", "Looks for a path of a part to a pose, or out of the assembly, and proves that it is free.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("-o,--out-path", options->out, "Path file to write")
      ->required()
      ->type_name("OUT.nfpath");
  command->add_option("--certificate", options->certificate, "Also write the certificate of the path")
      ->type_name("FILE.nfcert");
  command->add_option("--part", options->part, "Part that moves; default: what the scene has in hand")
      ->type_name("NAME");
  command->add_option("--group", options->group, "Group that moves as one")->type_name("NAME");
  command->add_flag("--to-drawn", options->isToDrawn, "To where the part was drawn");
  command->add_flag("--out", options->isOut, "Out of the assembly");
  command->add_option("--to", options->to, std::string("To a pose: ") + kPoseHelp)->type_name("POSE");
  command->add_option("--separation", options->separation,
                      "Distance to keep [m]; default: a millionth of the part, at most 1 um");
  command->add_option("--seconds", options->seconds, "Time of the search, with making the path shorter [s]")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Of the random search")->capture_default_str();
  command->add_option("--motions", options->motions, "Motions that each thread of the search tries at most");
  command->add_flag("--no-turns", options->isWithoutTurns, "Only shift the part");
  command->add_flag("--json", options->isJson, "Print the result as one JSON object");
  command->footer(kSuggestFooter);
  command->callback([options] { runSuggest(*options); });
}

}  // namespace nearfit::cli
