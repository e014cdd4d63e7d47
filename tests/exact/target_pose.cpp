#include "tests/exact/target_pose.h"

#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "tests/support/portable_random.h"

namespace nearfit::test {
namespace {

/// Zero, a power of ten down to 1e-12, or anything up to 1.
double weight(std::mt19937_64& random) {
  switch (random() % 3) {
    case 0:
      return 0.0;
    case 1:
      return std::pow(10.0, -12.0 * uniform(random));
    default:
      return uniform(random);
  }
}

glm::dvec3 normalOf(const TriangleMesh& mesh, std::uint32_t face) {
  const Triangle& t = mesh.triangles()[face];
  const auto x = mesh.vertices();
  const glm::dvec3 n = glm::cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]);
  const double length = glm::length(n);
  return length > 0.0 ? n / length : glm::dvec3(0.0);
}

struct Site {
  glm::dvec3 point, direction;
};

/// Somewhere on a mesh, and a direction that leaves it there.
Site randomSite(const TriangleMesh& mesh, std::mt19937_64& random) {
  const auto face = static_cast<std::uint32_t>(random() % mesh.triangles().size());
  const Triangle& t = mesh.triangles()[face];
  const std::size_t k = random() % 3;
  const double u = weight(random), v = weight(random) * (1.0 - u);
  const glm::dvec3 corner = mesh.vertices()[t[k]];
  Site site{corner + u * (mesh.vertices()[t[(k + 1) % 3]] - corner) +
                v * (mesh.vertices()[t[(k + 2) % 3]] - corner),
            (0.01 + weight(random)) * normalOf(mesh, face)};
  for (const std::uint32_t f : mesh.facesOfEdge(mesh.edgesOfTriangle(face)[k]))
    site.direction += weight(random) * normalOf(mesh, f);
  if (u == 0.0 && v == 0.0) {
    for (const std::uint32_t e : mesh.edgesOfVertex(t[k]))
      site.direction += weight(random) * normalOf(mesh, mesh.facesOfEdge(e)[0]);
  }
  const double length = glm::length(site.direction);
  site.direction = length > 1e-3 ? site.direction / length : glm::dvec3(0, 0, 1);
  return site;
}

}  // namespace

RigidTransform targetPose(const BodyPair& pair, double reach, std::mt19937_64& random) {
  const Site scene = randomSite(pair.scene, random), part = randomSite(pair.part, random);
  const double angle = 2.0 * std::numbers::pi * uniform(random);
  RigidTransform pose;
  pose.rotation = glm::angleAxis(angle, scene.direction) * glm::dquat(part.direction, -scene.direction);
  pose.translation =
      scene.point + reach * uniform(random) * scene.direction - pose.normalized().rotation * part.point;
  return pose;
}

RigidTransform alignedPose(const BodyPair& pair, double reach, std::mt19937_64& random) {
  const auto pick = [&](const TriangleMesh& mesh) {
    return mesh.vertices()[mesh.triangles()[random() % mesh.triangles().size()][random() % 3]];
  };
  // Quarter turns, as a user writes them: rounded, and so is what they turn.
  const double half = std::sqrt(0.5);
  const std::array<glm::dquat, 4> turns{{{1, 0, 0, 0}, {0, 1, 0, 0}, {half, half, 0, 0}, {half, 0, 0, half}}};
  RigidTransform pose{turns[random() % 4], {}};
  glm::dvec3 away(0.0);
  away[static_cast<int>(random() % 3)] = random() % 2 == 0 ? 0.5 * reach : -0.5 * reach;
  const glm::dvec3 onPart = pick(pair.part), onScene = pick(pair.scene);
  pose.translation = onScene - pose.rotation * onPart + away;
  return pose;
}

}  // namespace nearfit::test
