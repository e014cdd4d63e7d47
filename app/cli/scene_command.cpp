#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/haptic_options.h"
#include "app/cli/output.h"
#include "app/cli/scene_joints_command.h"
#include "core/base/error.h"
#include "core/scene/haptic_limits.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct SceneNewOptions {
  std::string out, moving, unit = "m";
  std::vector<std::string> parts, densities;
  HapticOptions haptics;
};

struct PartArgument {
  std::string name, file;
  RigidTransform worldFromPart;
};

/// Parses NAME=FILE[@POSE]. Text after the last @ belongs to the file name unless it is a pose.
PartArgument parsePart(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw UsageError("--part", fmt::format("\"{}\" is not a part", text), "give NAME=FILE or NAME=FILE@POSE");
  }
  PartArgument part{text.substr(0, equals), text.substr(equals + 1), {}};
  const std::size_t at = part.file.rfind('@');
  if (at == std::string::npos || at == 0) return part;
  const std::string tail = part.file.substr(at + 1);
  if (const auto pose = parsePoseIfAny(tail)) {
    part.worldFromPart = *pose;
    part.file.resize(at);
    return part;
  }
  std::error_code failure;
  const bool looksLikePose =
      !tail.empty() && tail.find_first_not_of("0123456789+-.,eE ") == std::string::npos;
  if (looksLikePose && !std::filesystem::exists(part.file, failure)) {
    throw UsageError("--part", fmt::format("\"{}\" is not a pose", tail), std::string("give ") + kPoseHelp);
  }
  return part;
}

/// Sets a density given as NAME=VALUE. Throws UsageError if there is no such part.
void setDensity(Scene& scene, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError("--density", fmt::format("\"{}\" is not a part's density", text), "give NAME=VALUE");
  }
  const Part* known = scene.findByName(text.substr(0, equals));
  if (known == nullptr) {
    throw UsageError("--density", fmt::format("there is no part \"{}\"", text.substr(0, equals)),
                     "name one that --part adds");
  }
  Part part = *known;
  part.density = parseNumbers<1>("--density", text.substr(equals + 1))[0];
  scene.replace(std::move(part));
}

HapticSettings newSettings(const HapticOptions& options) {
  HapticSettings settings;
  settings.proxy.margin = defaultMargin(options.cutoff.value_or(settings.springs.cutoff));
  return withOptions(settings, options);
}

/// Loads the parts, in colours that tell them apart. Throws UsageError if two have one name.
std::vector<Part> loadParts(const std::vector<PartArgument>& arguments, double metresPerUnit) {
  const std::vector<Colour> colours = Scene().nextColours(arguments.size());
  std::map<std::filesystem::path, PartGeometryPtr> geometries;
  std::set<std::string> names;
  std::vector<Part> parts;
  for (const PartArgument& argument : arguments) {
    if (!names.insert(argument.name).second) {
      throw UsageError("--part", fmt::format("two parts are named \"{}\"", argument.name),
                       "give each its own name");
    }
    PartGeometryPtr& geometry = geometries[normalisedPath(argument.file)];
    if (!geometry) geometry = loadPartGeometry(argument.file, metresPerUnit);
    Part& part = parts.emplace_back();
    part.name = argument.name;
    part.geometry = geometry;
    part.worldFromPart = argument.worldFromPart;
    part.colour = colours[parts.size() - 1];
  }
  return parts;
}

Scene makeScene(const SceneNewOptions& options) {
  const double metresPerUnit = parseUnit(options.unit);
  std::vector<PartArgument> arguments;
  arguments.reserve(options.parts.size());
  for (const std::string& text : options.parts)
    arguments.push_back(parsePart(text));

  Scene scene;
  scene.setHaptics(newSettings(options.haptics));
  scene.addAll(loadParts(arguments, metresPerUnit));
  for (const std::string& text : options.densities)
    setDensity(scene, text);
  if (!options.moving.empty()) {
    const Part* moving = scene.findByName(options.moving);
    if (moving == nullptr) {
      throw UsageError("--moving", fmt::format("there is no part \"{}\"", options.moving),
                       "name one that --part adds");
    }
    scene.setMovingPart(moving->id);
  }
  return scene;
}

void runSceneNew(const SceneNewOptions& options) {
  const Scene scene = makeScene(options);
  for (const Scene::PartPtr& part : scene.parts())
    checkTarget(options.out, std::span(&part->geometry->file, 1));
  writeSceneFile(scene, options.out);
  printCacheWarnings();
  std::set<PartGeometryPtr> meshes;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (meshes.insert(part->geometry).second) printWarnings(*part->geometry);
  }
  const std::string moving = options.moving.empty() ? "none" : options.moving;
  print(oneLine(fmt::format("wrote {}: {} part{}, moving: {}", options.out, scene.parts().size(),
                            scene.parts().size() == 1 ? "" : "s", moving)) +
        "\n");
}

constexpr const char* kSceneFooter =
    "A part is NAME=FILE[@POSE]: its name (without =), its mesh file, and its pose in the world,\n"
    "tx,ty,tz,qw,qx,qy,qz: translation [m] and unit quaternion; default: at the origin.\n"
    "A file name may contain @ if what follows the last one is not a pose.\n"
    "The scene file refers to each mesh by its path from the scene file's folder and by its SHA-256.\n"
    "An existing OUT is replaced.\n"
    "Example: nearfit-cli scene new fit.nearfit --unit mm --part Hole=hole.stl\n"
    "             --part Peg=peg.stl@0,0,0.05,1,0,0,0 --moving Peg --cutoff 0.005 --density Peg=7850";

void addSceneNew(CLI::App& scene) {
  const auto options = std::make_shared<SceneNewOptions>();
  CLI::App* command = scene.add_subcommand("new", "Makes a scene file from meshes.");
  command->add_option("out", options->out, "Scene file to write (*.nearfit)")->required()->type_name("OUT");
  command->add_option("--part", options->parts, "A part to add; repeat it for more")
      ->required()
      ->allow_extra_args(false)
      ->type_name("NAME=FILE[@POSE]");
  command->add_option("--moving", options->moving, "Name of the moving part")->type_name("NAME");
  command
      ->add_option(
          "--density", options->densities,
          fmt::format("Density of a part [kg/m^3], default: {}; repeat it for more", kDefaultDensity))
      ->allow_extra_args(false)
      ->type_name("NAME=VALUE");
  command->add_option("--unit", options->unit, kUnitHelp)->capture_default_str();
  const HapticSettings defaults;
  addHapticOptions(*command, options->haptics, &defaults);
  command->footer(kSceneFooter);
  command->callback([options] { runSceneNew(*options); });
}

}  // namespace

void addSceneCommand(CLI::App& program) {
  CLI::App* scene = program.add_subcommand("scene", "Works with scene files.");
  scene->require_subcommand(1);
  addSceneNew(*scene);
  addSceneKeep(*scene);
  addSceneRelease(*scene);
}

}  // namespace nearfit::cli
