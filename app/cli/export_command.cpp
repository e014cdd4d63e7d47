#include <filesystem>
#include <memory>
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
#include "core/report/scene_export.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct ExportOptions {
  std::string scene, out, unit = "mm", schema = "ap214";
  bool hasUnit = false, hasSchema = false;
  std::vector<std::string> parts;
};

constexpr const char* kExportFooter =
    "The suffix of OUT chooses the format:\n"
    "  .json  poses of all parts, and the clearances of the moving part\n"
    "  .csv   poses of all parts, one row per part: position [m], quaternion, matrix by rows\n"
    "  .stl   the parts as one mesh in the world frame, binary, single precision\n"
    "  .obj   the same in double precision, each part an object and a group of its name\n"
    "  .ply   the same, binary, in double precision, with the parts' colours\n"
    "  .step  the parts as an assembly with groups, names, colours and poses, in mm: exact surfaces for "
    "parts of STEP,\n"
    "         IGES and BREP files that are unchanged, facets for others; also .stp\n"
    "  .glb   the same as glTF 2.0, metres, y up\n"
    "  .3mf   the same as 3MF, in the unit of --unit: um, mm, cm, in, ft or m\n"
    "  .urdf  the same as a robot of fixed joints, metres, with its meshes in OUT_meshes\n"
    "A mesh or an assembly contains all visible parts, or those named by --part. An existing OUT is "
    "replaced.\n"
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
  const ExportKind kind = knownExportKindOf(options.out);
  if (!hasChosenParts(kind) && !options.parts.empty())
    throw UsageError("--part", "a placement always has all parts", "leave it out, or write a mesh");
  if (isAssembly(kind) && !hasUnitOfChoice(kind) && options.hasUnit)
    throw UsageError("--unit", "this format has a unit of its own", "leave it out");
  if (kind != ExportKind::AssemblyStep && options.hasSchema)
    throw UsageError("--schema", "only STEP files have one", "leave it out");
  SceneExport what;
  what.kind = kind;
  what.metresPerUnit = parseUnit(options.unit);
  what.schema = options.schema == "ap242" ? StepSchema::Ap242 : StepSchema::Ap214;
  const std::filesystem::path sceneFile = options.scene;
  checkTarget(options.out, std::span(&sceneFile, 1));
  const Scene scene = readSceneFile(options.scene);
  checkTarget(options.out, partFiles(scene));
  what.only = partsNamed(scene, options.parts);
  const Part* moving = scene.movingPart() ? scene.find(*scene.movingPart()) : nullptr;
  const std::vector<std::string> notes =
      exportScene(scene, moving != nullptr ? moving->worldFromPart : RigidTransform{}, what, options.out);
  printCacheWarnings();
  for (const std::string& note : notes)
    printError("warning: " + note);
  print(oneLine(fmt::format("wrote {}", options.out)) + "\n");
}

}  // namespace

void addExportCommand(CLI::App& program) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command = program.add_subcommand(
      "export", "Exports the poses of a scene's parts, or the parts as a mesh or an assembly.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("-o,out", options->out, "File to write")->required()->type_name("OUT");
  command
      ->add_option("--part", options->parts,
                   "For a mesh or an assembly: name of a part to include; repeat it for more")
      ->allow_extra_args(false)
      ->type_name("NAME");
  CLI::Option* unit =
      command
          ->add_option(
              "--unit", options->unit,
              "Unit of the coordinates of a mesh or a 3MF file: m, cm, mm, um, in, ft, or a number of metres")
          ->capture_default_str();
  CLI::Option* schema =
      command->add_option("--schema", options->schema, "Schema of a STEP file: ap214 or ap242")
          ->check(CLI::IsMember({"ap214", "ap242"}, CLI::ignore_case))
          ->capture_default_str();
  command->footer(kExportFooter);
  command->callback([options, unit, schema] {
    options->hasUnit = unit->count() > 0;
    options->hasSchema = schema->count() > 0;
    runExport(*options);
  });
}

}  // namespace nearfit::cli
