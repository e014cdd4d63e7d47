#include "tests/support/documents.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/files/sha256.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::test {
namespace {

/// Chord of a cylinder whose tessellation is left to the importer, over its radius.
constexpr double kDefaultChord = 0.02;

/// Which side of a box a triangle is on: 0 to 5 for -x, +x, -y, +y, -z, +z.
std::uint32_t sideOf(const TriangleMesh& box, const Triangle& t) {
  const auto& v = box.vertices();
  for (int axis = 0; axis < 3; ++axis) {
    if (v[t[0]][axis] == v[t[1]][axis] && v[t[1]][axis] == v[t[2]][axis])
      return static_cast<std::uint32_t>(2 * axis + (v[t[0]][axis] > 0.0 ? 1 : 0));
  }
  return 0;
}

DocumentImporter importerOf(const FakeImporter::Make& make, const std::shared_ptr<std::atomic<int>>& runs,
                            const std::function<void(const DocumentOptions&)>& note) {
  return [=](const std::filesystem::path& file, const DocumentOptions& options,
             const ProgressCallback& progress) {
    ++*runs;
    note(options);
    if (progress && !progress(0.5)) throw Cancelled();
    CadDocument document = make(options.tessellation);
    document.sha256 = sha256OfFile(file);
    if (!options.onlyShapes.empty()) {
      for (CadShape& shape : document.shapes) {
        if (std::ranges::find(options.onlyShapes, shape.key) == options.onlyShapes.end()) {
          shape.vertices.clear();
          shape.triangles.clear();
          shape.surfaces = {};
          shape.faceColours.clear();
        }
      }
    }
    return document;
  };
}

}  // namespace

CadShape shapeOf(const std::string& key, const TriangleMesh& mesh) {
  CadShape shape;
  shape.key = key;
  shape.vertices.assign(mesh.vertices().begin(), mesh.vertices().end());
  shape.triangles.assign(mesh.triangles().begin(), mesh.triangles().end());
  return shape;
}

CadShape boxShape(const std::string& key, const glm::dvec3& size) {
  const TriangleMesh box = boxMesh(size);
  CadShape shape = shapeOf(key, box);
  for (int side = 0; side < 6; ++side) {
    ExactSurface plane;
    plane.kind = SurfaceKind::Plane;
    plane.direction[side / 2] = side % 2 == 1 ? 1.0 : -1.0;
    plane.point = 0.5 * size * plane.direction;
    shape.surfaces.faces.push_back(plane);
  }
  for (const Triangle& t : box.triangles())
    shape.surfaces.faceOfTriangle.push_back(sideOf(box, t));
  shape.faceColours.resize(6);
  shape.faceColours.back() = CadColour{1.0F, 0.0F, 0.0F};
  shape.isExact = true;
  shape.exactVolume = size.x * size.y * size.z;
  shape.tessellation = {0.01, 0.3};
  return shape;
}

CadShape cylinderShape(const std::string& key, double radius, double height,
                       const Tessellation& tessellation) {
  const double chord = tessellation.chord > 0.0 ? tessellation.chord : kDefaultChord * radius;
  const double half = std::acos(std::max(0.0, 1.0 - chord / radius));
  const auto segments = static_cast<std::uint32_t>(std::max(3.0, std::ceil(std::numbers::pi / half)));
  const TriangleMesh mesh = cylinderMesh(radius, height, segments);
  CadShape shape = shapeOf(key, mesh);
  ExactSurface side, top, bottom;
  side.kind = SurfaceKind::Cylinder;
  side.direction = {0.0, 0.0, 1.0};
  side.radius = radius;
  top.kind = bottom.kind = SurfaceKind::Plane;
  top.point = {0.0, 0.0, 0.5 * height};
  top.direction = {0.0, 0.0, 1.0};
  bottom.point = -top.point;
  bottom.direction = -top.direction;
  shape.surfaces.faces = {side, top, bottom};
  for (const Triangle& t : mesh.triangles()) {
    const double z0 = mesh.vertices()[t[0]].z, z1 = mesh.vertices()[t[1]].z, z2 = mesh.vertices()[t[2]].z;
    shape.surfaces.faceOfTriangle.push_back(z0 != z1 || z1 != z2 ? 0U : z0 > 0.0 ? 1U : 2U);
  }
  shape.isExact = true;
  shape.exactVolume = std::numbers::pi * radius * radius * height;
  shape.tessellation = {chord, 2.0 * half};
  return shape;
}

CadNode assemblyNode(const std::string& name, std::int32_t parent, const RigidTransform& parentFromNode) {
  return instanceNode(name, parent, -1, parentFromNode);
}

CadNode instanceNode(const std::string& name, std::int32_t parent, std::int32_t shape,
                     const RigidTransform& parentFromNode) {
  CadNode node;
  node.parent = parent;
  node.name = name;
  node.parentFromNode = parentFromNode;
  node.shape = shape;
  return node;
}

CadDocument viseDocument(const Tessellation& tessellation) {
  CadDocument document;
  document.shapes = {boxShape("body", {0.1, 0.06, 0.04}), cylinderShape("pin", 0.005, 0.03, tessellation)};
  document.nodes = {assemblyNode("vise", -1),
                    instanceNode("body", 0, 0),
                    assemblyNode("jaws", 0, {{1, 0, 0, 0}, {0.1, 0.0, 0.0}}),
                    instanceNode("pin", 2, 1, {{1, 0, 0, 0}, {0.0, -0.02, 0.0}}),
                    instanceNode("pin", 2, 1, {{1, 0, 0, 0}, {0.0, 0.02, 0.0}}),
                    assemblyNode("screws", 0)};
  document.nodes[4].colour = CadColour{0.0F, 0.0F, 1.0F};
  return document;
}

FakeImporter::FakeImporter(Make make)
    : importer_(importerOf(std::move(make), runs_, [log = log_](const DocumentOptions& options) {
        const std::lock_guard lock(log->mutex);
        log->asked.push_back(options);
      })) {}

std::vector<DocumentOptions> FakeImporter::asked() const {
  const std::lock_guard lock(log_->mutex);
  return log_->asked;
}

}  // namespace nearfit::test
