#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
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
#include "core/path/assembly_path.h"
#include "core/path/path_animation.h"
#include "core/path/path_bodies.h"
#include "core/path/path_certifier.h"
#include "core/path/path_clearance.h"
#include "core/path/path_file.h"
#include "core/path/path_thinning.h"
#include "core/path/swept_volume.h"
#include "core/report/scene_export.h"
#include "core/scene/scene_file.h"
#include "core/servo/motion_reader.h"
#include "core/text/json_text.h"

namespace nearfit::cli {
namespace {

struct PathOptions {
  std::string input, scene, part, group, out, csv, gltf, clearance, swept, unit = "mm";
  std::optional<double> from, to, thin, smooth, separation, within, resolution;
  bool isJson = false;
};

constexpr const char* kPathFooter =
    "INPUT is a recording (*.csv, of nearfit or of nearfit-cli place --record) or a path file. Between two\n"
    "poses of a path the centre of what moves goes straight, and it turns about that at a constant rate.\n"
    "--thin and --smooth change the path only where it is proven that the part keeps the separation from "
    "all\n"
    "other visible parts; elsewhere the original stays.\n"
    "--clearance writes t_s and a column NAME [m] for each part that comes within the range, inf beyond it.\n"
    "Example: nearfit-cli path felt.csv fit.nearfit -o in.nfpath --from 2 --to 9.5 --thin 1e-4 --gltf in.glb";

std::optional<MeshFileKind> sweptKindOf(const PathOptions& options) {
  const std::optional<ExportKind> kind = exportKindOf(options.swept);
  return kind ? meshKindOf(*kind) : std::nullopt;
}

void checkPathOptions(const PathOptions& options) {
  for (const auto& [name, value] :
       {std::pair("--thin", options.thin), std::pair("--smooth", options.smooth),
        std::pair("--separation", options.separation), std::pair("--within", options.within),
        std::pair("--resolution", options.resolution)}) {
    if (value) checkPositive(name, *value);
  }
  if (options.within && options.clearance.empty())
    throw UsageError("--within", "it is the range of --clearance, which is not given", "give both, or none");
  if (options.resolution && options.swept.empty())
    throw UsageError("--resolution", "it is that of --swept, which is not given", "give both, or none");
  if (!options.swept.empty() && !sweptKindOf(options))
    throw UsageError(options.swept, "its suffix is not that of a mesh file", "use .stl, .obj or .ply");
  static_cast<void>(parseUnit(options.unit));
  if (options.separation && !options.thin && !options.smooth)
    throw UsageError("--separation", "nothing is proven without --thin or --smooth",
                     "give one of them, or certify the path (nearfit-cli certify)");
  const std::vector<std::string> outputs{options.out, options.csv, options.gltf, options.clearance,
                                         options.swept};
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!outputs[i].empty() && !outputs[k].empty() && isSameTarget(outputs[i], outputs[k]))
        throw UsageError(outputs[i], "two outputs have this name", "name different files");
    }
  }
}

/// Throws UsageError if an output would replace an input.
void checkPathTargets(const PathOptions& options, const Scene& scene) {
  std::vector<std::filesystem::path> inputs = partFiles(scene);
  inputs.insert(inputs.end(), {options.input, options.scene});
  for (const std::string& target :
       {options.out, options.csv, options.gltf, options.clearance, options.swept}) {
    if (!target.empty()) checkTarget(target, inputs);
  }
}

AssemblyPath pathOfInput(const PathOptions& options, const Scene& scene) {
  const double from = options.from.value_or(-std::numeric_limits<double>::infinity());
  const double to = options.to.value_or(std::numeric_limits<double>::infinity());
  if (!isJsonFile(options.input)) {
    const Recording recording = readRecording(options.input);
    if (recording.isCut) printError("warning: " + options.input + ": it ends in the middle of a row");
    return pathOfMotion(recording.rows, withInHand(scene, options.part, options.group, options.scene), from,
                        to);
  }
  if (!options.part.empty() || !options.group.empty())
    throw UsageError("--part", "a path file names its parts", "leave it out");
  const AssemblyPath path = readPathFile(options.input);
  return options.from || options.to ? trimmed(path, from, to) : path;
}

void runPath(const PathOptions& options) {
  checkPathOptions(options);
  const Scene scene = readSceneFile(options.scene);
  checkPathTargets(options, scene);
  AssemblyPath path = pathOfInput(options, scene);
  nlohmann::ordered_json summary;
  summary["parts"] = path.parts;
  summary["recorded_poses"] = path.poses.size();
  if (options.thin || options.smooth) {
    const double separation = options.separation ? *options.separation : defaultSeparation(scene, path);
    const PathCertifier certifier(scene, path, separation);
    summary["separation"] = separation;
    if (options.thin) {
      ChangedPath changed = thinned(path, certifier, *options.thin);
      path = std::move(changed.path);
      summary["left_out"] = changed.changed;
    }
    if (options.smooth) {
      ChangedPath changed = smoothed(path, certifier, *options.smooth);
      path = std::move(changed.path);
      summary["moved"] = changed.changed;
    }
  }
  summary["poses"] = path.poses.size();
  summary["from"] = path.poses.front().time;
  summary["to"] = path.poses.back().time;
  writePathFile(path, options.out);
  if (!options.csv.empty()) atomicWrite(options.csv, pathCsv(path));
  if (!options.gltf.empty()) writePathGlb(scene, path, options.gltf);
  if (!options.clearance.empty()) {
    // As for maps of clearance: farther away nothing is near.
    constexpr double kShareOfSize = 0.05;
    const double range =
        options.within ? *options.within : 2.0 * kShareOfSize * pathBodies(scene, path).radius;
    const std::vector<PathClearance> clearances = clearancesAlong(scene, path, range);
    atomicWrite(options.clearance, pathClearanceCsv(scene, path, clearances));
    const std::optional<LeastPathClearance> least = leastOf(clearances, path);
    summary["range"] = range;
    summary["min_clearance"] = least ? nlohmann::ordered_json(least->distance) : nlohmann::ordered_json();
    if (least) summary["min_at"] = least->time;
    if (least) summary["min_to"] = scene.get(least->other).name;
  }
  if (!options.swept.empty()) {
    const double resolution = options.resolution ? *options.resolution : defaultSweptResolution(scene, path);
    summary["swept_triangles"] =
        writeSweptVolume(scene, path, resolution, parseUnit(options.unit), options.swept);
    summary["resolution"] = resolution;
  }
  printCacheWarnings();
  if (options.isJson) return print(prettyJson(summary));
  for (const auto& [key, value] : summary.items())
    print(oneLine(fmt::format("{} {}", key, value.is_string() ? value.get<std::string>() : value.dump())) +
          "\n");
}

}  // namespace

void addPathCommand(CLI::App& program) {
  const auto options = std::make_shared<PathOptions>();
  CLI::App* command = program.add_subcommand(
      "path", "Makes a path of a recorded motion: trims, thins, smooths and exports it.");
  command->add_option("input", options->input, "Recording, or path file")->required()->type_name("INPUT");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("-o,--out", options->out, "Path file to write")->required()->type_name("OUT.nfpath");
  command->add_option("--part", options->part, "Part that moved; default: what the scene has in hand")
      ->type_name("NAME");
  command->add_option("--group", options->group, "Group that moved as one")->type_name("NAME");
  command->add_option("--from", options->from, "Start [s]; default: the first pose");
  command->add_option("--to", options->to, "End [s]; default: the last pose");
  command->add_option("--thin", options->thin,
                      "Leave out poses as long as no point of the part moves by more than this [m]");
  command->add_option("--smooth", options->smooth,
                      "Smooth poses as long as no point of the part moves by more than this [m]");
  command->add_option("--separation", options->separation,
                      "What --thin and --smooth keep from other parts [m]; default: a millionth of the part, "
                      "at most 1 um");
  command->add_option("--csv", options->csv, "Also write the poses as CSV")->type_name("FILE.csv");
  command->add_option("--gltf", options->gltf, "Also write the path as glTF animation")
      ->type_name("FILE.glb");
  command->add_option("--clearance", options->clearance, "Also write the clearance at each pose as CSV")
      ->type_name("FILE.csv");
  command->add_option("--within", options->within,
                      "Range of --clearance [m]; default: a tenth of the part's radius");
  command->add_option("--swept", options->swept, "Also write the space that the part passes as a mesh")
      ->type_name("FILE.(stl|obj|ply)");
  command->add_option(
      "--resolution", options->resolution,
      "Of --swept: the mesh holds all that is passed, and is nowhere farther than this from it [m]; "
      "default: a twentieth of the part");
  command
      ->add_option("--unit", options->unit,
                   "Unit of the coordinates of --swept: m, cm, mm, um, in, ft, or a number of metres")
      ->capture_default_str();
  command->add_flag("--json", options->isJson, "Print the summary as one JSON object");
  command->footer(kPathFooter);
  command->callback([options] { runPath(*options); });
}

}  // namespace nearfit::cli
