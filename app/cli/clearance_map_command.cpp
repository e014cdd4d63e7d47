#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "app/cli/scene_part.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/report/clearance_histogram.h"
#include "core/report/clearance_map_export.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct ClearanceMapOptions {
  std::string scene, part, out, histogram, unit = "mm";
  std::optional<double> range, threshold;
  bool hasNearParts = false;
};

constexpr const char* kClearanceMapFooter =
    "The distance at each sample of the part's surface to the nearest other visible part; inside that part, "
    "minus\n"
    "the depth. MAP.ply (binary) has vertices with x y z, nx ny nz, red green blue, distance (nan beyond the "
    "range)\n"
    "and part, only of triangles with a corner within the range; x y z and distance are in the unit, which "
    "the header\n"
    "names. The histogram has the columns\n"
    "from [m], to [m], area [m^2] and share of the surface.\n"
    "On stdout, a line each: range [m], samples, area [m^2], area within the range, min and mean distance "
    "within it\n"
    "[m] (nan if there is none), area in contact (within 1 um) and inside other parts, and with --threshold "
    "the area\n"
    "nearer than that.\n"
    "Example: nearfit-cli clearance-map fit.nearfit --part Peg --range 0.002 -o map.ply --histogram h.csv";

/// Throws UsageError if an output would replace an input or the other output.
void checkMapOutputs(const ClearanceMapOptions& options, const Scene& scene) {
  if (options.out.empty() && options.histogram.empty())
    throw UsageError("clearance-map", "there is nothing to write", "give -o MAP.ply or --histogram FILE.csv");
  for (const std::string& target : {options.out, options.histogram}) {
    if (target.empty()) continue;
    const std::filesystem::path sceneFile = options.scene;
    checkTarget(target, std::span(&sceneFile, 1));
    checkTarget(target, partFiles(scene));
  }
  if (!options.out.empty() && !options.histogram.empty() && isSameTarget(options.out, options.histogram))
    throw UsageError("--histogram", "it is the file of the map", "name another file");
}

std::string mapSummary(const ClearanceMap& map, const AreaByClearance& areas,
                       const ClearanceMapOptions& options) {
  std::string text;
  const auto add = [&text](const char* name, auto value) {
    fmt::format_to(std::back_inserter(text), "{} {}\n", name, value);
  };
  add("range", map.range);
  add("samples", map.samples());
  add("area", areas.total());
  add("area_within", areas.within());
  const auto least = leastClearanceOf(map, areas);
  add("min", least ? least->distance : std::nan(""));
  add("mean", areas.mean().value_or(std::nan("")));
  add("area_contact", areas.inContact());
  add("area_overlap", areas.overlapping());
  if (options.threshold) add("area_below", areas.nearerThan(*options.threshold));
  return text;
}

void runClearanceMap(const ClearanceMapOptions& options) {
  if (options.range) checkPositive("--range", *options.range);
  if (options.threshold) checkPositive("--threshold", *options.threshold, true);
  const double unit = parseUnit(options.unit);
  const Scene scene = readSceneFile(options.scene);
  checkMapOutputs(options, scene);
  const bool isGroup = options.part.empty() && scene.movingGroup();
  const std::vector<PartId> subject =
      isGroup ? scene.movingParts() : std::vector{chosenPart(scene, options.part)};
  const ClearanceMap map = ClearanceMapper().map(
      clearanceMapRequest(scene, subject, options.range.value_or(0.0), options.hasNearParts));
  const AreaByClearance areas(map.subject());
  if (!options.out.empty()) exportClearanceMap(map, scene, unit, options.out);
  if (!options.histogram.empty()) atomicWrite(options.histogram, histogramCsv(areas, map.range));
  printCacheWarnings();
  if (map.isCoarse)
    printError(fmt::format("warning: samples are farther apart than wanted, to keep to {}", kMaxMapSamples));
  print(mapSummary(map, areas, options));
}

}  // namespace

void addClearanceMapCommand(CLI::App& program) {
  const auto options = std::make_shared<ClearanceMapOptions>();
  CLI::App* command = program.add_subcommand(
      "clearance-map",
      "Writes the clearance over a part's surface as coloured PLY, and its histogram as CSV.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("--part", options->part, "Name of the part; default: the moving part or group")
      ->type_name("NAME");
  command->add_option("--range", options->range,
                      "Largest distance to map [m]; default: by the distances found");
  command->add_flag("--near", options->hasNearParts,
                    "Also write the surfaces of parts within the range, with their distance to the part");
  command->add_option("-o,--out", options->out, "Map to write")->type_name("MAP.ply");
  command->add_option("--histogram", options->histogram, "Histogram to write")->type_name("FILE.csv");
  command->add_option("--threshold", options->threshold, "Print the area nearer than this [m]");
  command
      ->add_option(
          "--unit", options->unit,
          "Unit of the map's coordinates and distances: m, cm, mm, um, in, ft, or a number of metres")
      ->capture_default_str();
  command->footer(kClearanceMapFooter);
  command->callback([options] { runClearanceMap(*options); });
}

}  // namespace nearfit::cli
