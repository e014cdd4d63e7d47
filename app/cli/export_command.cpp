#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "core/report/scene_export.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct ExportOptions {
  std::string scene, out, unit = "mm";
  std::vector<std::string> parts;
};

constexpr const char* kExportFooter =
    "The suffix of OUT chooses the format:\n"
    "  .json  poses of all parts, and the clearances of the moving part\n"
    "  .csv   poses of all parts, one row per part: position [m], quaternion, matrix by rows\n"
    "  .stl   the parts as one mesh in the world frame, binary, single precision\n"
    "  .obj   the same in double precision, each part an object and a group of its name\n"
    "  .ply   the same, binary, in double precision, with the parts' colours\n"
    "A mesh contains all visible parts, or those named by --part. An existing OUT is replaced.\n"
    "Example: nearfit-cli export fit.nearfit fit.stl --unit mm --part Peg";

std::vector<PartId> partsNamed(const Scene& scene, const std::vector<std::string>& names) {
  std::vector<PartId> parts;
  for (const std::string& name : names) {
    const Part* part = scene.findByName(name);
    if (part == nullptr)
      throw UsageError("--part", fmt::format("there is no part \"{}\"", name), "name a part of the scene");
    parts.push_back(part->id);
  }
  return parts;
}

void runExport(const ExportOptions& options) {
  const auto kind = exportKindOf(options.out);
  if (!kind)
    throw UsageError(options.out, "its suffix is not that of a known format",
                     "use .json, .csv, .stl, .obj or .ply");
  if (!meshKindOf(*kind) && !options.parts.empty())
    throw UsageError("--part", "a placement always has all parts", "leave it out, or write a mesh");
  SceneExport what{*kind, parseUnit(options.unit), {}, {}};
  const std::filesystem::path sceneFile = options.scene;
  checkTarget(options.out, std::span(&sceneFile, 1));
  const Scene scene = readSceneFile(options.scene);
  for (const Scene::PartPtr& part : scene.parts())
    checkTarget(options.out, std::span(&part->geometry->file, 1));
  what.only = partsNamed(scene, options.parts);
  const Part* moving = scene.movingPart() ? scene.find(*scene.movingPart()) : nullptr;
  exportScene(scene, moving != nullptr ? moving->worldFromPart : RigidTransform{}, what, options.out);
  printCacheWarnings();
  print(oneLine(fmt::format("wrote {}", options.out)) + "\n");
}

}  // namespace

void addExportCommand(CLI::App& program) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      program.add_subcommand("export", "Exports the poses of a scene's parts, or the parts as one mesh.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("out", options->out, "File to write")->required()->type_name("OUT");
  command->add_option("--part", options->parts, "For a mesh: name of a part to include; repeat it for more")
      ->allow_extra_args(false)
      ->type_name("NAME");
  command
      ->add_option("--unit", options->unit,
                   "Unit of a mesh's coordinates: m, cm, mm, um, in, ft, or a number of metres")
      ->capture_default_str();
  command->footer(kExportFooter);
  command->callback([options] { runExport(*options); });
}

}  // namespace nearfit::cli
