#include "core/report/mesh_export.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/report/mesh_file.h"
#include "core/scene/moving_body.h"

namespace nearfit {
namespace {

constexpr std::size_t kStlHeaderBytes = 80, kStlTriangleBytes = 50;
constexpr std::size_t kPlyVertexBytes = 3 * sizeof(double) + 3, kPlyFaceBytes = 1 + 3 * sizeof(std::uint32_t);
/// Approximate length of a line in an OBJ file.
constexpr std::size_t kObjVertexBytes = 58, kObjFaceBytes = 24;

glm::dvec3 placed(const Part& part, const glm::dvec3& vertex, double metresPerUnit) {
  return part.worldFromPart.applyToPoint(vertex) / metresPerUnit;
}

void appendSingle(MeshFile& out, const glm::dvec3& v) {
  for (glm::length_t k = 0; k < 3; ++k)
    out.append(static_cast<float>(v[k]));
}

void appendStlTriangle(MeshFile& out, const Part& part, const Triangle& triangle, double metresPerUnit) {
  glm::dvec3 corners[3];
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = placed(part, part.geometry->mesh.vertices()[triangle[k]], metresPerUnit);
  const glm::dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double length = glm::length(across);
  appendSingle(out, length > 0.0 ? across / length : glm::dvec3(0.0));
  for (const glm::dvec3& corner : corners)
    appendSingle(out, corner);
  out.append(std::uint16_t{0});
  out.step();
}

void writeStl(MeshFile& out, std::span<const Scene::PartPtr> parts, const MeshExportSize& size,
              double metresPerUnit) {
  // A header that begins with "solid" would be taken for text.
  std::string header = fmt::format("Nearfit; world frame; {} m to the unit", metresPerUnit);
  header.resize(kStlHeaderBytes, ' ');
  out.text() += header;
  out.append(static_cast<std::uint32_t>(size.triangles));
  for (const Scene::PartPtr& part : parts) {
    for (const Triangle& triangle : part->geometry->mesh.triangles())
      appendStlTriangle(out, *part, triangle, metresPerUnit);
  }
}

/// Blanks separate the names of groups.
std::string groupName(std::string name) {
  std::ranges::replace(name, ' ', '_');
  return name;
}

void writeObj(MeshFile& out, std::span<const Scene::PartPtr> parts, double metresPerUnit) {
  fmt::format_to(std::back_inserter(out.text()), "# Nearfit; world frame; {} m to the unit\n", metresPerUnit);
  std::uint64_t first = 1;
  for (const Scene::PartPtr& part : parts) {
    fmt::format_to(std::back_inserter(out.text()), "o {}\ng {}\n", part->name, groupName(part->name));
    const TriangleMesh& mesh = part->geometry->mesh;
    for (const glm::dvec3& vertex : mesh.vertices()) {
      const glm::dvec3 v = placed(*part, vertex, metresPerUnit);
      fmt::format_to(std::back_inserter(out.text()), "v {} {} {}\n", v.x, v.y, v.z);
      out.step();
    }
    for (const Triangle& t : mesh.triangles()) {
      fmt::format_to(std::back_inserter(out.text()), "f {} {} {}\n", first + t[0], first + t[1],
                     first + t[2]);
      out.step();
    }
    first += mesh.vertices().size();
  }
}

void writePlyVertices(MeshFile& out, const Part& part, double metresPerUnit) {
  for (const glm::dvec3& vertex : part.geometry->mesh.vertices()) {
    const glm::dvec3 v = placed(part, vertex, metresPerUnit);
    for (glm::length_t k = 0; k < 3; ++k)
      out.append(v[k]);
    out.append(part.colour);
    out.step();
  }
}

void writePly(MeshFile& out, std::span<const Scene::PartPtr> parts, const MeshExportSize& size,
              double metresPerUnit) {
  fmt::format_to(std::back_inserter(out.text()),
                 "ply\nformat binary_little_endian 1.0\ncomment Nearfit; world frame; {} m to the unit\n"
                 "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
                 "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                 "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                 metresPerUnit, size.vertices, size.triangles);
  for (const Scene::PartPtr& part : parts)
    writePlyVertices(out, *part, metresPerUnit);
  std::uint32_t first = 0;
  for (const Scene::PartPtr& part : parts) {
    for (const Triangle& t : part->geometry->mesh.triangles()) {
      out.append(std::uint8_t{3});
      for (const std::uint32_t corner : t)
        out.append(first + corner);
      out.step();
    }
    first += static_cast<std::uint32_t>(part->geometry->mesh.vertices().size());
  }
}

void requireExportable(const MeshExportSize& size) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
  if (size.triangles == 0)
    throw UsageError("mesh export", "there is nothing to write", "select parts, or show some");
  if (size.triangles > kMax || size.vertices > kMax)
    throw UsageError("mesh export", fmt::format("{} triangles are more than a file can hold", size.triangles),
                     "export fewer parts at a time");
}

}  // namespace

std::string_view extensionOf(MeshFileKind kind) noexcept {
  switch (kind) {
    case MeshFileKind::StlBinary:
      return "stl";
    case MeshFileKind::Obj:
      return "obj";
    case MeshFileKind::Ply:
      break;
  }
  return "ply";
}

Scene placedScene(const Scene& scene, const RigidTransform& worldFromMoving) {
  Scene placed = scene;
  if (!scene.movingPart()) return placed;
  for (const auto& [id, pose] : movedPoses(scene, checkedPose(worldFromMoving))) {
    Part moved = scene.get(id);
    moved.worldFromPart = pose;
    placed.replace(std::move(moved));
  }
  return placed;
}

std::vector<Scene::PartPtr> chosenParts(const Scene& scene, std::span<const PartId> only) {
  std::vector<Scene::PartPtr> parts;
  const std::set<PartId> chosen(only.begin(), only.end());
  for (const Scene::PartPtr& part : scene.parts()) {
    const bool isChosen = only.empty() ? part->isVisible : chosen.contains(part->id);
    if (isChosen && part->geometry) parts.push_back(part);
  }
  return parts;
}

MeshExportSize meshExportSize(std::span<const Scene::PartPtr> parts, MeshFileKind kind) noexcept {
  MeshExportSize size;
  size.parts = parts.size();
  for (const Scene::PartPtr& part : parts) {
    size.vertices += part->geometry->mesh.vertices().size();
    size.triangles += part->geometry->mesh.triangles().size();
  }
  switch (kind) {
    case MeshFileKind::StlBinary:
      size.bytes = kStlHeaderBytes + sizeof(std::uint32_t) + kStlTriangleBytes * size.triangles;
      break;
    case MeshFileKind::Obj:
      size.bytes = kObjVertexBytes * size.vertices + kObjFaceBytes * size.triangles;
      break;
    case MeshFileKind::Ply:
      size.bytes = kPlyVertexBytes * size.vertices + kPlyFaceBytes * size.triangles;
      break;
  }
  return size;
}

MeshExportSize exportMesh(std::span<const Scene::PartPtr> parts, MeshFileKind kind, double metresPerUnit,
                          const std::filesystem::path& file, const ProgressCallback& progress) {
  checkMetresPerUnit(metresPerUnit);
  MeshExportSize size = meshExportSize(parts, kind);
  requireExportable(size);
  MeshFile out(file, size.vertices + size.triangles, progress);
  switch (kind) {
    case MeshFileKind::StlBinary:
      writeStl(out, parts, size, metresPerUnit);
      break;
    case MeshFileKind::Obj:
      writeObj(out, parts, metresPerUnit);
      break;
    case MeshFileKind::Ply:
      writePly(out, parts, size, metresPerUnit);
      break;
  }
  size.bytes = out.commit();
  return size;
}

}  // namespace nearfit
