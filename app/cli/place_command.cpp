#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/cli/commands.h"
#include "app/cli/haptic_options.h"
#include "app/cli/output.h"
#include "app/cli/place_run.h"
#include "app/cli/place_summary.h"
#include "core/error.h"
#include "core/report/placement_export.h"
#include "core/scene/scene_file.h"
#include "device/simulated_device.h"

namespace nearfit::cli {
namespace {

constexpr const char* kFooter =
    R"(The part starts at the path's first pose; the scene file stays as it is. Options of the feel count for this
run, instead of what the scene says.
--record  CSV with a header and a row a tick, in the world frame: t_s; handle_tx ... handle_qz and
          proxy_tx ... proxy_qz (tx ty tz qw qx qy qz each; the proxy is where the part is); force_x ...
          force_z [N] and torque_x ... torque_z [N m] about the part's centre of mass, as sent to the device
          and so within its limits; lmds; distance, the least [m], "inf" when nothing is within the cutoff;
          query_us; tick_us; late_bodies, those that the tick searched anew as the lists were not ready;
          energy, given to the hand since the start, less what came back [J]; sub_steps, of the proxy in
          this tick; shortened and refused, those of them that would have met something; constraints and
          contacts, minima that its last step kept in mind and those that held it; released, parts that are
          overlapped and not felt; proxy_us, of tick_us without queries; clamped, 0 or 1; fault, 0 for none
          (the summary says which).
--export  JSON: each part's pose and mesh, and the minima left between the part that was led and each other.
A tick that ends too late skips periods instead of rows: the path then takes longer, and the summary says so.
Example: nearfit-cli place fit.nearfit --part Peg --path hand.csv --record felt.csv --export placed.json)";

struct PlaceOptions {
  std::string scene, part, path, record, exportFile;
  HapticOptions haptics;
  bool isFast = false, isJson = false;
};

std::string knownNames(const Scene& scene) {
  std::string names;
  for (const Scene::PartPtr& part : scene.parts())
    names += (names.empty() ? "" : ", ") + part->name;
  return names.empty() ? "the scene has no parts" : "its parts are " + names;
}

/// The part starts where the path does.
void takeInHand(Scene& scene, const PlaceOptions& options, const RigidTransform& start) {
  const Part* part = scene.findByName(options.part);
  if (part == nullptr) {
    throw UsageError(options.scene, "there is no part \"" + options.part + "\"", knownNames(scene));
  }
  if (part->isLocked) {
    throw UsageError(options.scene, "part \"" + options.part + "\" is locked",
                     "unlock it, or choose another");
  }
  if (!part->isVisible) {
    throw UsageError(options.scene, "part \"" + options.part + "\" is hidden, so it would feel nothing",
                     "show it, or choose another");
  }
  Part placed = *part;
  placed.worldFromPart = start;
  scene.replace(placed);
  scene.setMovingPart(placed.id);
}

/// Told before the run, not after it.
void checkTargets(const PlaceOptions& options) {
  if (!options.record.empty() && options.record == options.exportFile) {
    throw UsageError("--record", "it names the same file as --export", "give two files");
  }
  for (const std::filesystem::path file : {options.record, options.exportFile}) {
    std::error_code ignored;
    const std::filesystem::path folder = file.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
      throw FileError(file.string(), "there is no folder " + folder.string(), "make it, or choose another");
    }
    if (std::filesystem::is_directory(file, ignored)) {
      throw FileError(file.string(), "it is a folder", "give a file name");
    }
  }
}

/// Neither output may take the place of an input.
void checkInputsAreKept(const Scene& scene, const PlaceOptions& options) {
  std::vector<std::filesystem::path> inputs = {options.scene, options.path};
  for (const Scene::PartPtr& part : scene.parts())
    inputs.push_back(part->geometry->file);
  checkTarget(options.record, inputs);
  checkTarget(options.exportFile, inputs);
}

void throwIfIncomplete(const PlaceResult& result, std::size_t poses) {
  if (result.fault != ServoFault::None) throw Error("servo", faultReason(result.fault));
  if (result.isInterrupted) {
    throw Error(
        "place",
        "interrupted after " + std::to_string(result.ticks) + " of " + std::to_string(poses) + " ticks",
        "the files hold what was done till then");
  }
  if (result.lostRows > 0) {
    throw Error("place", std::to_string(result.lostRows) + " ticks were not recorded: the disk was too slow",
                "record to a faster disk, or run with --fast");
  }
}

void runPlace(const PlaceOptions& options) {
  checkTargets(options);
  PlaceJob job;
  job.path = readPosePath(options.path);
  Scene scene = readSceneFile(options.scene);
  checkInputsAreKept(scene, options);
  takeInHand(scene, options, job.path.front());
  job.scene = makeServoScene(scene);
  job.parameters.haptics = withOptions(scene.haptics(), options.haptics);
  const ServoParameters parameters = job.parameters;
  std::optional<MotionWriter> writer;
  if (!options.record.empty()) job.writer = &writer.emplace(options.record);

  const std::size_t poses = job.path.size(), others = job.scene->bodies.size();
  const PlaceResult result = options.isFast ? placeFast(std::move(job)) : placeInRealTime(std::move(job));
  if (writer) writer->finish();
  if (!options.exportFile.empty()) exportPlacement(scene, result.end, options.exportFile);

  const PlaceSummary summary{options.part,      others, poses, parameters, result, options.record,
                             options.exportFile};
  print(options.isJson ? summaryJson(summary) : summaryText(summary));
  throwIfIncomplete(result, poses);
}

}  // namespace

void addPlaceCommand(CLI::App& program) {
  const auto options = std::make_shared<PlaceOptions>();
  CLI::App* command = program.add_subcommand(
      "place", "Leads a part along a path of poses with the 1 kHz servo and says what it felt.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required();
  command->add_option("--part", options->part, "Name of the part to lead")->required();
  command
      ->add_option("--path", options->path,
                   "CSV file of poses, world from part: tx,ty,tz,qw,qx,qy,qz a row, one row a tick of 1 ms")
      ->required();
  command->add_flag("--fast", options->isFast, "As fast as it goes, instead of in real time");
  command->add_option("--record", options->record,
                      "Write poses, wrench and minima of every tick to this CSV file");
  command->add_option("--export", options->exportFile, "Write the placement at the end to this JSON file");
  command->add_flag("--json", options->isJson, "Print the summary as one JSON object");
  addHapticOptions(*command, options->haptics);
  command->footer(kFooter);
  command->callback([options] { runPlace(*options); });
}

}  // namespace nearfit::cli
