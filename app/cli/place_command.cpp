#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/device_options.h"
#include "app/cli/haptic_options.h"
#include "app/cli/output.h"
#include "app/cli/place_run.h"
#include "app/cli/place_summary.h"
#include "app/cli/rate_options.h"
#include "app/cli/scene_part.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/report/mesh_export.h"
#include "core/report/placement_export.h"
#include "core/scene/scene_file.h"
#include "core/servo/path_run.h"
#include "core/servo/start_apart.h"
#include "device/simulated/replay_device.h"
#include "device/simulated/simulated_device.h"

namespace nearfit::cli {
namespace {

constexpr const char* kPlaceFooter =
    R"(The part starts at the first pose of the path or recording, a group with its first part there; moved by
any other device, it stays where it is until the device moves. The scene file does not change. Feel options
replace the scene's for this run.
--record  CSV with a header and one row per tick, in the world frame: t_s; handle_tx ... handle_qz and
          proxy_tx ... proxy_qz (tx ty tz qw qx qy qz each; the proxy is where the part is); force_x ...
          force_z [N] and torque_x ... torque_z [N m] about the part's centre of mass, as sent to the device
          and so within its limits; lmds; distance, the min [m], "inf" if nothing is within the cutoff;
          query_us; tick_us; late_bodies, parts that the tick searched itself because no list was ready;
          energy, given to the hand since the start, less what came back [J]; sub_steps, of the proxy in
          this tick; shortened and refused, those cut short or not taken because of a collision;
          constraints and contacts, minima that limited its last step and those that held it; released,
          parts that the moving part overlaps, which the proxy does not feel; proxy_us, time of the proxy without its
          queries; clamped, 0 or 1; fault, 0 for none (the summary says which).
--export  JSON: each part's pose and mesh, and the minima between the led part and each other part.
A tick that ends late skips periods, not rows: the run then takes longer, and the summary says so. If the disk
is full, the recording ends there and keeps its rows.
Examples: nearfit-cli place fit.nearfit --part Peg --path hand.csv --record felt.csv --export placed.json
          nearfit-cli place fit.nearfit --part Peg --device openhap --arm --record felt.csv
          nearfit-cli place fit.nearfit --part Peg --device replay:felt.csv --record again.csv)";

struct PlaceOptions {
  std::string scene, part, group, path, device, record, exportFile;
  HapticOptions haptics;
  DeviceFiles deviceFiles;
  RateOptions rate;
  std::optional<double> seconds;
  bool isFast = false, isArming = false, isCalibrating = false, isJson = false, isLedByDevice = false;
};

std::string knownNames(const Scene& scene) {
  std::string names;
  for (const Scene::PartPtr& part : scene.parts())
    names += (names.empty() ? "" : ", ") + part->name;
  return names.empty() ? "the scene has no parts" : "its parts are " + names;
}

/// Makes the named group move as one; the path is that of the part that leads it.
void takeGroupInHand(Scene& scene, const PlaceOptions& options, const RigidTransform* start) {
  scene.setMovingGroup(namedGroup(scene, options.group, options.scene));
  const std::vector<PartId> parts = scene.movingParts();
  if (std::ranges::none_of(parts, [&](PartId id) { return scene.get(id).isVisible; })) {
    throw UsageError(options.scene,
                     "all of group \"" + options.group + "\" is hidden, so it would feel nothing",
                     "show it, or choose another");
  }
  if (start != nullptr) scene = placedScene(scene, *start);
}

/// Names of the parts that move as one, the one that leads first; none for a part alone.
std::vector<std::string> membersOf(const Scene& scene) {
  std::vector<std::string> names;
  if (!scene.movingGroup()) return names;
  names.push_back(scene.get(*scene.movingPart()).name);
  for (const PartId id : scene.movingParts()) {
    if (id != *scene.movingPart()) names.push_back(scene.get(id).name);
  }
  return names;
}

/// Makes the named part, or group, what the hand moves.
/// @param start  First pose of a path or recording; null: it stays where it is.
void takeInHand(Scene& scene, const PlaceOptions& options, const RigidTransform* start) {
  if (!options.group.empty()) return takeGroupInHand(scene, options, start);
  const Part* part = scene.findByName(options.part);
  if (part == nullptr) {
    throw UsageError(options.scene, "there is no part \"" + options.part + "\"", knownNames(scene));
  }
  scene =
      withInHandAt(scene, part->id, start != nullptr ? std::optional(*start) : std::nullopt, options.scene);
}

/// Throws before the run, not after it, if an output file cannot be written.
void checkTargets(const PlaceOptions& options) {
  for (const std::filesystem::path file : {options.record, options.exportFile}) {
    if (file.empty()) continue;
    std::error_code ignored;
    const std::filesystem::path folder = file.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
      throw FileError(file.string(), "there is no folder " + folder.string(), "create it, or choose another");
    }
    checkReplaceable(file);
  }
  if (!options.record.empty() && !options.exportFile.empty() &&
      isSameTarget(options.record, options.exportFile)) {
    throw UsageError("--record", "it names the same file as --export", "give two files");
  }
}

/// Throws UsageError if an output would replace an input.
void checkInputsAreKept(const Scene& scene, const PlaceOptions& options) {
  std::vector<std::filesystem::path> inputs = {
      options.scene, options.path, options.deviceFiles.falconFirmware, options.deviceFiles.polhemCalibration};
  if (const auto recording = recordingMeant(options.device)) inputs.push_back(*recording);
  std::ranges::copy(partFiles(scene), std::back_inserter(inputs));
  checkTarget(options.record, inputs);
  checkTarget(options.exportFile, inputs);
}

void throwIfIncomplete(const PlaceResult& result, std::size_t poses) {
  if (result.fault != ServoFault::None) throw Error("servo", faultReason(result.fault));
  if (result.device && !result.device->trouble.empty()) {
    throw Error(result.device->name, result.device->trouble, "the files contain everything up to then");
  }
  if (result.isInterrupted) {
    throw Error(
        "place",
        "interrupted after " + std::to_string(result.ticks) + " of " + std::to_string(poses) + " ticks",
        "the files contain everything up to then");
  }
  if (result.lostRows > 0) {
    throw Error("place", std::to_string(result.lostRows) + " ticks were not recorded: the disk was too slow",
                result.device ? "record to a faster disk" : "record to a faster disk, or run with --fast");
  }
}

void checkLead(const PlaceOptions& options) {
  if (options.part.empty() && options.group.empty())
    throw UsageError("place", "it does not say what moves", "give --part NAME or --group NAME");
  if (options.isLedByDevice != options.path.empty()) {
    throw UsageError("place",
                     options.isLedByDevice ? "--path and --device are both given" : "nothing moves the part",
                     "give either --path FILE or --device");
  }
  if (options.isLedByDevice && options.isFast)
    throw UsageError("--fast", "a device sets its own pace", "leave it out");
  if (!options.isLedByDevice && (options.isArming || options.isCalibrating || options.seconds)) {
    const char* option = options.isArming ? "--arm" : options.isCalibrating ? "--calibrate" : "--seconds";
    throw UsageError(option, "it is for --device", "leave it out");
  }
  if (!options.isLedByDevice && options.rate.isGiven())
    throw UsageError("options of space mice", "they are for --device", "leave them out");
  if (options.seconds) checkPositive("--seconds", *options.seconds);
}

PlaceResult lead(PlaceJob job, bool isFast) {
  if (job.device) return placeWithDevice(std::move(job));
  return isFast ? placeFast(std::move(job)) : placeInRealTime(std::move(job));
}

/// Keeps the rows that were written before the recording failed, and throws the failure with what is kept.
[[noreturn]] void failKeepingRows(MotionWriter& writer, const FileError& failure) {
  std::optional<double> last;
  try {
    last = writer.keepWritten();
  } catch (const FileError&) {
    // Report the first failure only.
  }
  if (!last) throw failure;
  throw FileError(failure.where(), failure.problem(),
                  fmt::format("{}; the file keeps the rows up to {:.3f} s", failure.remedy(), *last));
}

/// Leads the part and completes the recording, if there is one. If that cannot be written, it keeps the rows
/// that were.
PlaceResult leadAndRecord(PlaceJob job, bool isFast) {
  MotionWriter* const writer = job.writer;
  try {
    PlaceResult result = lead(std::move(job), isFast);
    if (writer != nullptr) writer->finish();
    return result;
  } catch (const FileError& failure) {
    if (writer != nullptr) failKeepingRows(*writer, failure);
    throw;
  }
}

void runPlace(const PlaceOptions& options) {
  checkTargets(options);
  checkLead(options);
  PlaceJob job;
  if (!options.isLedByDevice) job.path = readPosePath(options.path);
  Scene scene = readSceneFile(options.scene);
  checkInputsAreKept(scene, options);
  std::optional<RigidTransform> start;
  if (!options.isLedByDevice) start = job.path.front();
  // A recorded hand feels the same only from the same pose.
  if (const auto recording = recordingMeant(options.device))
    start = readHandMotion(*recording).front().worldFromHandle;
  takeInHand(scene, options, start ? &*start : nullptr);
  if (options.isLedByDevice) {
    job.device = deviceMeant(options.device, options.deviceFiles);
    applyRateOptions(options.rate, *job.device);
  }
  job.seconds = options.seconds;
  job.isArming = options.isArming;
  job.isCalibrating = options.isCalibrating;
  job.parameters.haptics = withOptions(scene.haptics(), options.haptics);
  auto servoScene = makeServoScene(scene);
  if (job.parameters.haptics.mode == HapticMode::Proxy) startApart(*servoScene);
  job.scene = std::move(servoScene);
  const std::string& name = options.group.empty() ? options.part : options.group;
  if (job.scene->areJointsContradictory)
    printError(oneLine(name + ": its joints contradict each other, so that none holds it"));
  ServoParameters parameters = job.parameters;
  std::optional<MotionWriter> writer;
  if (!options.record.empty()) job.writer = &writer.emplace(options.record);

  const std::size_t poses = job.path.size(), others = job.scene->bodies.size();
  const PlaceResult result = leadAndRecord(std::move(job), options.isFast);
  if (result.device) parameters.limits = result.device->limits;
  if (!options.exportFile.empty()) exportPlacement(scene, result.end, options.exportFile);

  const PlaceSummary summary{
      name, others, poses, parameters, result, options.record, options.exportFile, membersOf(scene)};
  printCacheWarnings();
  print(options.isJson ? summaryJson(summary) : summaryText(summary));
  throwIfIncomplete(result, poses);
}

}  // namespace

void addPlaceCommand(CLI::App& program) {
  const auto options = std::make_shared<PlaceOptions>();
  CLI::App* command = program.add_subcommand(
      "place", "Moves a part along a path or with a device in the 1 kHz servo, and prints what was felt.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required();
  CLI::Option* part = command->add_option("--part", options->part, "Name of the part to move");
  command
      ->add_option("--group", options->group,
                   "Instead of a part: name of the group whose parts move as one; the path is that of its "
                   "first part")
      ->excludes(part);
  command->add_option(
      "--path", options->path,
      "CSV file of poses in the world frame: tx,ty,tz,qw,qx,qy,qz per row, one row per tick of 1 ms");
  CLI::Option* device = command->add_option(
      "--device", options->device,
      "Instead of a path: a device that is plugged in (see nearfit-cli devices); default: the first usable "
      "one. Ctrl+C ends. replay:FILE plays back the hand of a recording (--record) with its own timing");
  device->type_name("[DEVICE]")->expected(0, 1);
  command->add_flag("--arm", options->isArming, "Let the device push; otherwise forces are only reported");
  command->add_flag("--calibrate", options->isCalibrating, kCalibrateHelp);
  command->add_option("--seconds", options->seconds, "With --device: end after this time [s]")
      ->type_name("S");
  addDeviceFileOptions(*command, options->deviceFiles);
  addRateOptions(*command, options->rate);
  command->add_flag("--fast", options->isFast, "As fast as possible instead of in real time");
  command->add_option("--record", options->record,
                      "Write poses, wrench and minima of every tick to this CSV file");
  command->add_option("--export", options->exportFile, "Write the placement at the end to this JSON file");
  command->add_flag("--json", options->isJson, "Print the summary as one JSON object");
  addHapticOptions(*command, options->haptics);
  command->footer(kPlaceFooter);
  command->callback([options, device] {
    options->isLedByDevice = !device->empty();
    runPlace(*options);
  });
}

}  // namespace nearfit::cli
