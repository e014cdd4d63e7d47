#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/python/bindings.h"
#include "app/python/interrupts.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/report/scene_export.h"
#include "core/scene/mesh_unit.h"
#include "core/scene/part_files.h"

namespace nearfit::python {
namespace {

using namespace nb::literals;

StepSchema schemaNamed(const std::string& name) {
  if (name == "ap214") return StepSchema::Ap214;
  if (name == "ap242") return StepSchema::Ap242;
  throw UsageError("schema", fmt::format("there is no schema \"{}\"", name), "give ap214 or ap242");
}

std::vector<std::string> exportTo(const HeldScene& held, const std::filesystem::path& file,
                                  const std::string& unit, const std::vector<std::string>& parts,
                                  const std::string& schema) {
  SceneExport what;
  what.kind = knownExportKindOf(file);
  if (!hasChosenParts(what.kind) && !parts.empty())
    throw UsageError("parts", "a placement always has all parts", "leave it out, or write a mesh");
  what.metresPerUnit = parseMeshUnit(unit, "unit");
  what.schema = schemaNamed(schema);
  for (const std::string& name : parts)
    what.only.push_back(held.part(name).id);
  const Scene scene = held.scene();
  checkTarget(file, partFiles(scene));
  const Part* moving = scene.movingPart() ? scene.find(*scene.movingPart()) : nullptr;
  return withoutLock([&](const ProgressCallback& progress) {
    return exportScene(scene, moving != nullptr ? moving->worldFromPart : RigidTransform{}, what, file,
                       progress);
  });
}

}  // namespace

void bindExports(nb::module_& module) {
  module.def("export", &exportTo, "scene"_a, "file"_a, nb::kw_only(), "unit"_a = "mm",
             "parts"_a = std::vector<std::string>(), "schema"_a = "ap214",
             "Exports a scene as nearfit-cli export does; the suffix chooses the format: .json or .csv for "
             "poses, .stl, .obj or "
             ".ply for one mesh, .step, .glb, .3mf or .urdf for an assembly. Returns sentences about what "
             "the file does not "
             "hold, as a rule none.\n\n"
             "unit: of the numbers in a mesh or 3MF file. parts: names of those to export; default: all "
             "visible ones. schema: of "
             "a STEP file, ap214 or ap242. STEP files need the program nearfit-export: name it in the "
             "variable NEARFIT_EXPORT.");
}

}  // namespace nearfit::python
