#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/python/arrays.h"
#include "app/python/bindings.h"
#include "app/python/interrupts.h"
#include "core/base/error.h"
#include "core/report/scene_mesh_files.h"
#include "core/scene/scene_file.h"

namespace nearfit::python {
namespace {

using namespace nb::literals;

HeldScene openScene(const std::filesystem::path& file) {
  return HeldScene(
      withoutLock([&](const ProgressCallback& progress) { return readSceneFile(file, progress); }));
}

void saveScene(HeldScene& held, const std::filesystem::path& file) {
  const Scene scene = held.scene();
  Scene saved = withoutLock([&](const ProgressCallback&) {
    Scene named = withMeshFiles(scene, file);
    writeSceneFile(named, file);
    return named;
  });
  // Only then do the parts know their files; the meshes are the same ones.
  if (held.scene().parts() == scene.parts()) held.set(std::move(saved));
}

std::string addPart(HeldScene& held, const Mesh& mesh, const std::optional<std::string>& name,
                    const std::optional<ArrayLike>& pose, double density, bool isVisible) {
  Part part;
  part.name = name.value_or(mesh.geometry->file.empty() ? "Part" : mesh.geometry->file.stem().string());
  part.geometry = mesh.geometry;
  part.colour = held.scene().nextColour();
  part.density = density;
  part.isVisible = isVisible;
  if (pose) part.worldFromPart = poseOf(*pose);
  return held.add(std::move(part)).name;
}

std::vector<std::string> partNames(const HeldScene& held) {
  std::vector<std::string> names;
  for (const Scene::PartPtr& part : held.scene().parts())
    names.push_back(part->name);
  return names;
}

Mesh meshOfPart(const HeldScene& held, const std::string& name) {
  const Part& part = held.part(name);
  if (!part.geometry) throw UsageError(name, "it has no mesh", "choose another part");
  return {part.geometry};
}

/// Where the part is in its centre of mass, in the world.
Vector worldCentreOf(const HeldScene& held, const std::string& name) {
  const Part& part = held.part(name);
  const glm::dvec3 centre =
      part.worldFromPart.applyToPoint(part.geometry ? part.geometry->mass.centre : glm::dvec3(0.0));
  return arrayOf<Vector>(std::vector<double>{centre.x, centre.y, centre.z}, {3});
}

std::string sceneText(const HeldScene& held) {
  return fmt::format("<nearfit.Scene of {} parts>", held.scene().parts().size());
}

}  // namespace

void bindScene(nb::module_& module) {
  nb::class_<HeldScene>(module, "Scene",
                        "Parts (named meshes with poses in the world), as in a scene file (*.nearfit). "
                        "Queries are against visible parts. Not "
                        "to be changed by one thread while another one uses it.")
      .def(nb::init<>(), "An empty scene.")
      .def_static("open", &openScene, "path"_a, "Reads a scene file (*.nearfit) and its meshes.")
      .def("save", &saveScene, "path"_a,
           "Writes the scene file, atomically. Meshes that were built get PLY files in the folder "
           "NAME_meshes beside it.")
      .def("add", &addPart, "mesh"_a, "name"_a = nb::none(), "pose"_a = nb::none(), nb::kw_only(),
           "density"_a = kDefaultDensity, "visible"_a = true,
           "Adds a part and returns its name: that of the mesh's file by default, with a number if it is "
           "taken. The same "
           "mesh may be added again; parts then share it.\n\n"
           "pose: (4, 4) world from part, or (7,) tx ty tz [m] qw qx qy qz; default: the origin. density: "
           "[kg/m^3].")
      .def("remove", &HeldScene::remove, "name"_a, "Removes a part.")
      .def("show", &HeldScene::show, "name"_a, "visible"_a = true,
           "Shows or hides a part: hidden ones are in nobody's way.")
      .def(
          "is_visible",
          [](const HeldScene& held, const std::string& name) { return held.part(name).isVisible; }, "name"_a,
          "False if the part is hidden.")
      .def_prop_ro("parts", &partNames, "Names of the parts, oldest first.")
      .def(
          "pose",
          [](const HeldScene& held, const std::string& name) {
            return matrixOf(held.part(name).worldFromPart);
          },
          "name"_a, "(4, 4) float64: world from part.")
      .def(
          "pose_row",
          [](const HeldScene& held, const std::string& name) {
            return rowsOf(std::vector{held.part(name).worldFromPart});
          },
          "name"_a, "(1, 7) float64: the pose as tx ty tz [m], qw qx qy qz, to the last bit.")
      .def(
          "set_pose",
          [](HeldScene& held, const std::string& name, const ArrayLike& pose) {
            held.setPose(name, poseOf(pose));
          },
          "name"_a, "pose"_a, "Moves a part. pose: (4, 4) world from part, or (7,) tx ty tz [m] qw qx qy qz.")
      .def("mesh", &meshOfPart, "name"_a, "The mesh of a part, in the part's frame.")
      .def("centre", &worldCentreOf, "name"_a, "(3,) float64: the part's centre of mass in the world [m].")
      .def("__len__", [](const HeldScene& held) { return held.scene().parts().size(); })
      .def(
          "__contains__",
          [](const HeldScene& held, const std::string& name) {
            return held.scene().findByName(name) != nullptr;
          },
          "name"_a)
      .def("__repr__", &sceneText);
}

}  // namespace nearfit::python
