#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/python/arrays.h"
#include "app/python/bindings.h"
#include "app/python/interrupts.h"
#include "core/base/error.h"
#include "core/scene/built_geometry.h"
#include "core/scene/mesh_hash.h"
#include "core/scene/mesh_unit.h"

namespace nearfit::python {
namespace {

using namespace nb::literals;

std::vector<glm::dvec3> verticesOf(nb::handle object) {
  const Doubles numbers(object);
  if (numbers.shape().size() != 2 || numbers.shape()[1] != 3)
    throw UsageError("vertices", fmt::format("their shape is ({})", fmt::join(numbers.shape(), ", ")),
                     "give an array (n, 3)");
  const std::span<const double> n = numbers.values();
  std::vector<glm::dvec3> vertices;
  vertices.reserve(n.size() / 3);
  for (std::size_t i = 0; i + 2 < n.size(); i += 3)
    vertices.emplace_back(n[i], n[i + 1], n[i + 2]);
  return vertices;
}

/// Doubles hold every index that a mesh may have.
std::vector<Triangle> trianglesOf(nb::handle object, std::size_t vertices) {
  const Doubles numbers(object);
  if (numbers.shape().size() != 2 || numbers.shape()[1] != 3)
    throw UsageError("triangles", fmt::format("their shape is ({})", fmt::join(numbers.shape(), ", ")),
                     "give an array (m, 3)");
  const std::span<const double> n = numbers.values();
  std::vector<Triangle> triangles;
  triangles.reserve(n.size() / 3);
  for (std::size_t i = 0; i + 2 < n.size(); i += 3) {
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double index = n[i + k];
      if (!(index >= 0.0 && index < static_cast<double>(vertices)) || index != std::floor(index)) {
        throw UsageError(fmt::format("triangle {}", i / 3), fmt::format("{} is no index of a vertex", index),
                         fmt::format("give integers from 0 to {}", static_cast<double>(vertices) - 1.0));
      }
      triangle[k] = static_cast<std::uint32_t>(index);
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

void buildMeshOf(Mesh* mesh, const ArrayLike& vertices, const ArrayLike& triangles) {
  std::vector<glm::dvec3> corners = verticesOf(vertices);
  const std::vector<Triangle> faces = trianglesOf(triangles, corners.size());
  PartGeometryPtr geometry =
      withoutLock([&](const ProgressCallback&) { return builtGeometry(std::move(corners), faces); });
  new (mesh) Mesh{std::move(geometry)};
}

Mesh readMesh(const std::filesystem::path& file, const std::string& unit) {
  const double metresPerUnit = parseMeshUnit(unit, "unit");
  return {withoutLock(
      [&](const ProgressCallback& progress) { return loadPartGeometry(file, metresPerUnit, progress); })};
}

TableView<double> verticesView(const Mesh& mesh) {
  const std::span<const glm::dvec3> vertices = mesh.geometry->mesh.vertices();
  return viewOf<TableView<double>>(vertices.data(), {vertices.size(), 3}, nb::find(mesh));
}

TableView<std::uint32_t> trianglesView(const Mesh& mesh) {
  const std::span<const Triangle> triangles = mesh.geometry->mesh.triangles();
  return viewOf<TableView<std::uint32_t>>(triangles.data(), {triangles.size(), 3}, nb::find(mesh));
}

Vector centreOf(const Mesh& mesh) {
  const glm::dvec3& centre = mesh.geometry->mass.centre;
  return arrayOf<Vector>(std::vector<double>{centre.x, centre.y, centre.z}, {3});
}

/// The path by os.fsdecode(): it need not be UTF-8.
nb::str fileOf(const Mesh& mesh) {
  const std::string& path = mesh.geometry->file.native();
  auto text =
      nb::steal<nb::str>(PyUnicode_DecodeFSDefaultAndSize(path.data(), static_cast<Py_ssize_t>(path.size())));
  if (!text.is_valid()) throw nb::python_error();
  return text;
}

std::string meshText(const Mesh& mesh) {
  const TriangleMesh& own = mesh.geometry->mesh;
  return fmt::format("<nearfit.Mesh of {} vertices and {} triangles>", own.vertices().size(),
                     own.triangles().size());
}

}  // namespace

void bindMesh(nb::module_& module) {
  nb::class_<Mesh>(module, "Mesh", "A triangle mesh in metres, in its own frame. Does not change.")
      .def("__init__", &buildMeshOf, "vertices"_a, "triangles"_a,
           "Builds a mesh as a file of it would be read: equal vertices are merged, faces without area "
           "dropped, closed "
           "shells turned outside out. So its vertices may be fewer and in another order.\n\n"
           "vertices: (n, 3) float64 [m]. triangles: (m, 3) integers, anticlockwise when seen from outside.")
      .def_prop_ro("vertices", &verticesView, "(n, 3) float64 [m]; read-only, without a copy.")
      .def_prop_ro("triangles", &trianglesView,
                   "(m, 3) uint32, indices of vertices; read-only, without a copy.")
      .def_prop_ro(
          "fingerprint", [](const Mesh& mesh) { return meshSha256(mesh.geometry->mesh); },
          "SHA-256 of vertices and triangles as bits, 64 hexadecimal digits: equal for equal meshes.")
      .def_prop_ro("file", &fileOf,
                   "The file that it was read from, as os.fsdecode() has it; empty if it was built.")
      .def_prop_ro(
          "warnings", [](const Mesh& mesh) { return mesh.geometry->report.warnings; },
          "A sentence for each defect that was found on reading or building.")
      .def_prop_ro("centre", &centreOf, nb::rv_policy::automatic, "(3,) float64: its centre of mass [m].")
      .def_prop_ro(
          "volume", [](const Mesh& mesh) { return mesh.geometry->mass.volume; },
          "[m^3]; of its oriented box if it is not closed.")
      .def_prop_ro(
          "is_solid", [](const Mesh& mesh) { return mesh.geometry->isSolid(); },
          "True if it encloses its material.")
      .def("__repr__", &meshText);
  module.def(
      "read_mesh", &readMesh, "path"_a, "unit"_a = "mm",
      "Reads a mesh file (STL, OBJ, PLY, OFF, also compressed by gzip) or a CAD document of one shape. CAD "
      "documents need the program nearfit-import: name it in the variable NEARFIT_IMPORT.\n\n"
      "unit: of the coordinates of files that store none: m, cm, mm, um, in, ft, or a number of metres.");
}

}  // namespace nearfit::python
