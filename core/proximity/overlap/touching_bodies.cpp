#include "core/proximity/overlap/touching_bodies.h"

#include <cstdint>

#include <glm/geometric.hpp>

#include "core/mesh/triangle_mesh.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/overlap/interference.h"

namespace nearfit {
namespace {

/// A shorter sum of normals has no direction.
constexpr double kNoDirection = 1e-6;

/// Returns the outward unit normal of a triangle; zero if it has no area.
glm::dvec3 normalOf(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles()[triangle];
  const auto vertices = mesh.vertices();
  const glm::dvec3 normal = glm::cross(vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]);
  const double length = glm::length(normal);
  return length > 0.0 ? normal / length : glm::dvec3(0.0);
}

/// Two bodies that meet.
struct MeetingBodies {
  const NormalConeTree &scene, &part;
  const RigidTransform& sceneFromPart;
  Interference found;
};

/// Returns a direction in which the part leaves where these triangles meet, in the scene's frame.
glm::dvec3 wayOut(const MeetingBodies& bodies, const Interference& found) {
  return normalOf(bodies.scene.mesh(), found.sceneTriangle) -
         bodies.sceneFromPart.applyToVector(normalOf(bodies.part.mesh(), found.partTriangle));
}

/// True if a translation by `tolerance` separates the bodies. Each pair of triangles that still meets turns the
/// direction its way.
bool isSeparated(const MeetingBodies& bodies, glm::dvec3 direction, double tolerance) {
  constexpr int kTries = 9;
  Interference found = bodies.found;
  for (int i = 0; i < kTries; ++i) {
    direction += wayOut(bodies, found);
    const double length = glm::length(direction);
    if (!(length > kNoDirection)) return false;
    RigidTransform moved = bodies.sceneFromPart;
    moved.translation += tolerance / length * direction;
    found = findInterference(bodies.scene, bodies.part, moved);
    if (found.kind == InterferenceKind::Disjoint) return true;
    if (found.kind != InterferenceKind::SurfacesMeet) return false;
  }
  return false;
}

}  // namespace

bool doOnlyTouch(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                 double tolerance) {
  return doOnlyTouch(scene, part, sceneFromPart, tolerance, findInterference(scene, part, sceneFromPart));
}

bool doOnlyTouch(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                 double tolerance, const Interference& found) {
  const MeetingBodies bodies{scene, part, sceneFromPart, found};
  if (bodies.found.kind != InterferenceKind::SurfacesMeet) return false;
  if (isSeparated(bodies, glm::dvec3(0.0), tolerance)) return true;
  // Faces that are flush beside the contact have normals that cancel: of equal boxes on each other, for example.
  const glm::dvec3 apart = sceneFromPart.applyToPoint(part.centre()) - scene.centre();
  const double length = glm::length(apart);
  return length > 0.0 && isSeparated(bodies, 2.0 / length * apart, tolerance);
}

}  // namespace nearfit
