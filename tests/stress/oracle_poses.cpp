#include "tests/stress/oracle_poses.h"

#include <array>
#include <cmath>
#include <numbers>

#include "tests/exact/target_pose.h"

namespace nearfit::stress {
namespace {

/// A turn of a cube, or one by 45 degrees besides: quaternions as they are written with whole numbers (their
/// length is none that a double has), or of unit length to rounding.
glm::dquat latticeTurn(std::mt19937_64& random) {
  const auto axis = [&random] {
    glm::dvec3 a(0.0);
    a[static_cast<int>(random() % 3)] = random() % 2 == 0 ? 1.0 : -1.0;
    return a;
  };
  const auto quarters = [&](const glm::dvec3& a) {
    const std::array<glm::dquat, 3> turns{glm::dquat(1, 0, 0, 0), glm::dquat(1, a.x, a.y, a.z),
                                          glm::dquat(0, a.x, a.y, a.z)};
    return turns[random() % turns.size()];
  };
  glm::dquat turn = quarters(axis()) * quarters(axis());
  if (random() % 3 == 0) turn = turn * glm::angleAxis(std::numbers::pi / 4.0, axis());
  return random() % 2 == 0 ? turn : glm::normalize(turn);
}

/// A corner, the middle of a side, a quarter of it, or a point in a face, with weights that are exact.
glm::dvec3 latticePoint(const TriangleMesh& mesh, std::mt19937_64& random) {
  constexpr std::array<std::array<double, 3>, 5> kWeights{
      {{1, 0, 0}, {0.5, 0.5, 0}, {0.25, 0.75, 0}, {0.5, 0.25, 0.25}, {0.125, 0.5, 0.375}}};
  const Triangle& t = mesh.triangles()[random() % mesh.triangles().size()];
  const std::array<double, 3>& w = kWeights[random() % kWeights.size()];
  const std::size_t k = random() % 3;
  return w[0] * mesh.vertices()[t[k]] + w[1] * mesh.vertices()[t[(k + 1) % 3]] +
         w[2] * mesh.vertices()[t[(k + 2) % 3]];
}

RigidTransform latticePose(const test::BodyPair& pair, double reach, std::mt19937_64& random) {
  RigidTransform pose{latticeTurn(random), glm::dvec3(0.0)};
  glm::dvec3 away(0.0);
  // Along one axis mostly: what is equal across it stays equal.
  for (std::uint64_t n = 1 + (random() % 4 == 0 ? 1 : 0); n > 0; --n)
    away[static_cast<int>(random() % 3)] = (random() % 2 == 0 ? reach : -reach) / (random() % 2 == 0 ? 2 : 4);
  pose.translation =
      latticePoint(pair.scene, random) + away - pose.normalized().rotation * latticePoint(pair.part, random);
  return pose;
}

RigidTransform parallelPose(const test::BodyPair& pair, double reach, std::mt19937_64& random) {
  constexpr std::array<double, 6> kTilts{0.0, 0.0, 1e-12, 1e-9, 3e-7, 3e-6};
  const RigidTransform pose =
      test::poseWithParallelFaces(pair, reach, kTilts[random() % kTilts.size()], random);
  // A face without area faces nothing.
  return pose.isFinite() ? pose : test::poseNearContact(pair, reach, random);
}

}  // namespace

OraclePose randomOraclePose(const test::BodyPair& pair, double reach, std::mt19937_64& random) {
  switch (random() % 20) {
    case 0:
    case 1:
      return {PoseKind::Lattice, latticePose(pair, reach, random)};
    case 2:
      return {PoseKind::Aligned, test::alignedPose(pair, reach, random)};
    case 3:
    case 4:
      return {PoseKind::Target, test::targetPose(pair, reach, random)};
    case 5:
      return {PoseKind::Parallel, parallelPose(pair, reach, random)};
    default:
      return {PoseKind::Random, test::poseNearContact(pair, reach, random)};
  }
}

}  // namespace nearfit::stress
