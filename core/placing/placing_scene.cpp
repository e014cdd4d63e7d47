#include "core/placing/placing_scene.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/mesh/mass_properties.h"

namespace nearfit {
namespace {

/// Merges the meshes, in the frame of `worldFromAll`. Where meshes cross, the result has no inside, and
/// contact counts from either side.
PartGeometryPtr joined(std::span<const Part* const> parts, const RigidTransform& worldFromAll) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  for (const Part* part : parts) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const RigidTransform allFromPart = (worldFromAll.inverse() * part->worldFromPart).normalized();
    for (const glm::dvec3& vertex : part->geometry->mesh.vertices())
      vertices.push_back(allFromPart.applyToPoint(vertex));
    for (const Triangle& t : part->geometry->mesh.triangles())
      triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  PartGeometry geometry;
  geometry.mesh = TriangleMesh(std::move(vertices), std::move(triangles));
  geometry.mass = massProperties(geometry.mesh);
  return std::make_shared<const PartGeometry>(std::move(geometry));
}

}  // namespace

std::shared_ptr<const ServoScene> makePlacingScene(const Scene& scene, std::span<const PartId> moved,
                                                   const ProgressCallback& progress) {
  const Part& first = scene.get(moved.front());
  std::vector<const Part*> felt;
  for (const PartId id : moved) {
    const Part& part = scene.get(id);
    if (part.isVisible && part.geometry != nullptr) felt.push_back(&part);
  }
  auto result = std::make_shared<ServoScene>();
  if (felt.empty()) {
    result->setMoving({first.id, nullptr, first.worldFromPart});
    return result;
  }
  const bool isAlone = felt.size() == 1 && felt.front() == &first;
  result->setMoving(
      {first.id, isAlone ? first.geometry : joined(felt, first.worldFromPart), first.worldFromPart});
  for (const Scene::PartPtr& part : scene.parts()) {
    const bool isMoved = std::ranges::find(moved, part->id) != moved.end();
    if (isMoved || !part->isVisible || part->geometry == nullptr) continue;
    result->bodies.push_back({part->id, part->geometry, part->worldFromPart});
  }
  std::vector<PartGeometryPtr> geometries{result->moving.geometry};
  for (const ServoScene::Body& body : result->bodies)
    geometries.push_back(body.geometry);
  prepareHierarchies(geometries, progress);
  result->prepareSurfaces();
  return result;
}

}  // namespace nearfit
