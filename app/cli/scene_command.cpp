#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/document_options.h"
#include "app/cli/haptic_options.h"
#include "app/cli/output.h"
#include "app/cli/scene_finding_command.h"
#include "app/cli/scene_joints_command.h"
#include "app/cli/scene_part.h"
#include "app/cli/scene_refine_command.h"
#include "app/cli/scene_rule_command.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/scene/document_load.h"
#include "core/scene/document_parts.h"
#include "core/scene/haptic_limits.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct SceneNewOptions {
  std::string out, moving, unit;
  std::vector<std::string> parts, imports, densities;
  TessellationOptions tessellation;
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
                     "name one that --part or --import adds");
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

/// Loads the parts and groups of a new scene; each document once.
NewNodes loadNodes(const std::vector<PartArgument>& arguments, const SceneNewOptions& options,
                   double metresPerUnit, std::vector<std::string>& warnings) {
  const Tessellation tessellation = tessellationOf(options.tessellation);
  std::set<std::string> names;
  NewNodes nodes;
  std::vector<MeshSource> sources;
  std::map<std::pair<std::filesystem::path, std::string>, std::size_t> known;
  std::vector<std::size_t> sourceOf;
  const auto addFile = [&](const std::string& text, const std::string& name, const RigidTransform& pose) {
    const FileArgument file = fileArgumentOf(text);
    const auto [source, isNew] = known.try_emplace({normalisedPath(file.file), file.shape}, sources.size());
    if (isNew)
      sources.push_back({file.file, unitToOpen(file.file, metresPerUnit), {}, file.shape, tessellation});
    sourceOf.push_back(source->second);
    nodes.parts.push_back({nullptr, name, pose, {}, {}});
  };
  for (const PartArgument& argument : arguments) {
    if (!names.insert(argument.name).second) {
      throw UsageError("--part", fmt::format("two parts are named \"{}\"", argument.name),
                       "give each its own name");
    }
    addFile(argument.file, argument.name, argument.worldFromPart);
  }
  std::vector<std::string> documents;
  for (const std::string& text : options.imports) {
    const FileArgument file = fileArgumentOf(text);
    if (isDocumentFile(file.file) && file.shape.empty())
      documents.push_back(file.file);
    else
      addFile(text, std::filesystem::path(file.file).stem().string(), {});
  }
  const std::vector<LoadedPart> loaded = loadPartGeometries(sources);
  for (const LoadedPart& each : loaded) {
    if (each.problem) std::rethrow_exception(each.problem);
  }
  for (std::size_t i = 0; i < sourceOf.size(); ++i)
    nodes.parts[i].geometry = loaded[sourceOf[i]].geometry;
  // A colour for each part, as ever, also where two are of one mesh.
  const std::vector<Colour> colours = Scene().nextColours(nodes.parts.size());
  for (std::size_t i = 0; i < colours.size(); ++i)
    nodes.parts[i].colour = colours[i];
  for (const std::string& file : documents) {
    const LoadedDocument document = loadDocument(file, metresPerUnit, tessellation);
    for (const std::string& warning : document.warnings)
      warnings.push_back(fmt::format("warning: {}: {}", file, warning));
    nodes.append(partsOfDocument(document, {}));
  }
  return nodes;
}

/// @param warnings  Receives what is to be said of the documents.
Scene makeScene(const SceneNewOptions& options, std::vector<std::string>& warnings) {
  std::vector<PartArgument> arguments;
  std::vector<std::string> files;
  for (const std::string& text : options.parts) {
    arguments.push_back(parsePart(text));
    files.push_back(fileArgumentOf(arguments.back().file).file);
  }
  for (const std::string& text : options.imports)
    files.push_back(fileArgumentOf(text).file);
  if (files.empty())
    throw UsageError("--part", "there is nothing to make a scene of", "give --part or --import");
  const double metresPerUnit = unitOfFiles(options.unit, files);

  Scene scene;
  scene.setHaptics(newSettings(options.haptics));
  addTo(scene, loadNodes(arguments, options, metresPerUnit, warnings));
  for (const std::string& text : options.densities)
    setDensity(scene, text);
  if (!options.moving.empty()) {
    const Part* moving = scene.findByName(options.moving);
    if (moving == nullptr) {
      throw UsageError("--moving", fmt::format("there is no part \"{}\"", options.moving),
                       "name one that --part or --import adds");
    }
    scene.setMovingPart(moving->id);
  }
  return scene;
}

void runSceneNew(const SceneNewOptions& options) {
  std::vector<std::string> warnings;
  const Scene scene = makeScene(options, warnings);
  checkTarget(options.out, partFiles(scene));
  writeSceneFile(scene, options.out);
  printCacheWarnings();
  for (const std::string& warning : warnings)
    printError(warning);
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
    "A file name may contain @ if what follows the last one is not a pose. Of a CAD document, FILE#KEY names "
    "one\n"
    "of several shapes, which nearfit-cli info lists; the part is that shape in its own frame.\n"
    "--import keeps a document as it is: its assemblies become groups, its instances parts, where it places "
    "them.\n"
    "The scene file refers to each mesh by its path from the scene file's folder and by its SHA-256.\n"
    "An existing OUT is replaced.\n"
    "Example: nearfit-cli scene new fit.nearfit --unit mm --part Hole=hole.stl\n"
    "             --part Peg=peg.stl@0,0,0.05,1,0,0,0 --moving Peg --cutoff 0.005 --density Peg=7850\n"
    "         nearfit-cli scene new vise.nearfit --import vise.step --moving Jaw";

void addSceneNew(CLI::App& scene) {
  const auto options = std::make_shared<SceneNewOptions>();
  CLI::App* command = scene.add_subcommand("new", "Makes a scene file from meshes and CAD documents.");
  command->add_option("out", options->out, "Scene file to write (*.nearfit)")->required()->type_name("OUT");
  command->add_option("--part", options->parts, "A part to add; repeat it for more")
      ->allow_extra_args(false)
      ->type_name("NAME=FILE[@POSE]");
  command
      ->add_option("--import", options->imports,
                   "A CAD document to add with its tree, or a mesh file; repeat it for more")
      ->allow_extra_args(false)
      ->type_name("FILE");
  command->add_option("--moving", options->moving, "Name of the moving part")->type_name("NAME");
  command
      ->add_option(
          "--density", options->densities,
          fmt::format("Density of a part [kg/m^3], default: {}; repeat it for more", kDefaultDensity))
      ->allow_extra_args(false)
      ->type_name("NAME=VALUE");
  command->add_option("--unit", options->unit, kFileUnitHelp);
  addTessellationOptions(*command, options->tessellation);
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
  addSceneRefine(*scene);
  addSceneRule(*scene);
  addSceneFinding(*scene);
}

}  // namespace nearfit::cli
