#include "app/cli/scene_refine_command.h"

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/document_options.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "core/scene/refinement.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct RefineOptions {
  std::string scene;
  std::vector<std::string> parts;
  TessellationOptions tessellation;
};

/// The parts with these names; all that can be refined if there are none.
std::vector<PartId> partsToRefine(const Scene& scene, const std::vector<std::string>& names) {
  std::vector<PartId> parts;
  for (const std::string& name : names) {
    const Part* part = scene.findByName(name);
    if (part == nullptr)
      throw UsageError("PART", fmt::format("there is no part \"{}\"", name), "name a part of the scene");
    parts.push_back(part->id);
  }
  for (const Scene::PartPtr& part : scene.parts()) {
    if (names.empty() && isRefinable(*part)) parts.push_back(part->id);
  }
  if (parts.empty())
    throw UsageError("PART", "the scene has no part of exact surfaces",
                     "add parts of a STEP, IGES or BREP file");
  return parts;
}

void runSceneRefine(const RefineOptions& options) {
  Scene scene = readSceneFile(options.scene);
  const Refinement refinement =
      refinementOf(scene, partsToRefine(scene, options.parts), tessellationOf(options.tessellation));
  const std::vector<LoadedPart> loaded = loadPartGeometries(refinement.sources);
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    if (loaded[i].problem) std::rethrow_exception(loaded[i].problem);
    if (loaded[i].geometry == nullptr)
      throw FileError(refinement.sources[i].file.string(), "it has changed while it was read", "try again");
  }
  for (const Refinement::Member& member : refinement.members) {
    Part part = scene.get(member.part);
    scene.requireUnlocked(part);
    part.geometry = loaded[member.source].geometry;
    scene.replace(std::move(part));
  }
  writeSceneFile(scene, options.scene);
  std::size_t triangles = 0;
  for (const LoadedPart& each : loaded)
    triangles += each.geometry->mesh.triangles().size();
  print(oneLine(fmt::format("wrote {}: {} part{} of {} shape{} with {} triangles", options.scene,
                            refinement.members.size(), refinement.members.size() == 1 ? "" : "s",
                            loaded.size(), loaded.size() == 1 ? "" : "s", triangles)) +
        "\n");
}

}  // namespace

void addSceneRefine(CLI::App& scene) {
  const auto options = std::make_shared<RefineOptions>();
  CLI::App* command =
      scene.add_subcommand("refine", "Gives parts of CAD documents a finer or coarser tessellation.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("part", options->parts, "Names of the parts; default: all of exact surfaces")
      ->type_name("PART");
  addTessellationOptions(*command, options->tessellation);
  command->footer(
      "All instances of the parts' shapes follow; poses stay. Without --chord and --angle they get back the\n"
      "tessellation that suits their size. The scene file is replaced.\n"
      "Example: nearfit-cli scene refine fit.nearfit Pin --chord 1e-5");
  command->callback([options] { runSceneRefine(*options); });
}

}  // namespace nearfit::cli
