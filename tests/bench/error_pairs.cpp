#include "tests/bench/error_pairs.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/error_shapes.h"
#include "tests/bench/portable_random.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench {
namespace {

using std::numbers::pi;
using Random = std::mt19937_64;
using Contacts = std::vector<TrueContact>;

constexpr double kCutoff = 0.25;
constexpr glm::dvec3 kVertical{0.0, 0.0, 1.0};

/// Share of the cutoff: nearest minimum, farthest that counts, and nearest that does not.
constexpr double kNearest = 0.35, kFarthest = 0.85, kBeyond = 1.25;
constexpr int kMaxProposals = 100'000;

double between(Random& random, double low, double high) {
  return low + (high - low) * uniform(random);
}

/// A distance at which a minimum counts.
double randomGap(Random& random) {
  return kCutoff * between(random, kNearest, kFarthest);
}

glm::dquat randomTurn(Random& random) {
  return glm::angleAxis(between(random, 0.0, 2.0 * pi), randomDirection(random)) *
         glm::angleAxis(between(random, 0.0, 2.0 * pi), randomDirection(random));
}

/// The part's z axis at an angle from upright, spun at random about itself and about the vertical.
glm::dquat randomTilt(Random& random, double tilt) {
  return glm::angleAxis(between(random, 0.0, 2.0 * pi), kVertical) *
         glm::angleAxis(tilt, glm::dvec3(1.0, 0.0, 0.0)) *
         glm::angleAxis(between(random, 0.0, 2.0 * pi), kVertical);
}

double radians(double degrees) {
  return degrees * pi / 180.0;
}

using FloorContact = std::function<std::optional<TrueContact>(const RigidTransform&)>;

/// A solid above a wide slab: turned at random, then lifted until its gap is what is wanted.
ErrorPair onFloor(std::string name, std::string description, std::function<TriangleMesh(std::uint32_t)> part,
                  const FloorContact& contact, std::function<glm::dquat(Random&)> turn) {
  ErrorPair pair{std::move(name), std::move(description)};
  pair.scene = [](std::uint32_t) { return test::boxMesh({4.0, 4.0, 0.5}, {0.0, 0.0, -0.25}); };
  pair.part = std::move(part);
  pair.contacts = [contact](const RigidTransform& pose) -> Contacts {
    const std::optional<TrueContact> one = contact(pose);
    return one ? Contacts{*one} : Contacts{};
  };
  pair.proposePose = [contact, turn = std::move(turn)](Random& random) {
    RigidTransform pose{turn(random), {between(random, -0.5, 0.5), between(random, -0.5, 0.5), 2.0}};
    const std::optional<TrueContact> one = contact(pose);
    pose.translation.z += randomGap(random) - (one ? one->distance : 0.0);
    return pose;
  };
  return pair;
}

ErrorPair sphereOnSphere() {
  ErrorPair pair{"sphere-sphere", "a ball of radius 0.5 m beside one of 1 m"};
  pair.isSceneCurved = true;
  pair.scene = [](std::uint32_t n) { return geodesicSphereMesh(1.0, 2 * n); };
  pair.part = [](std::uint32_t n) { return geodesicSphereMesh(0.5, n); };
  pair.contacts = [](const RigidTransform& pose) -> Contacts {
    return {sphereSphere({glm::dvec3(0.0), 1.0}, {pose.translation, 0.5})};
  };
  pair.proposePose = [](Random& random) -> RigidTransform {
    return {randomTurn(random), (1.5 + randomGap(random)) * randomDirection(random)};
  };
  return pair;
}

/// Three balls with a hollow between them, a ball above it: three contacts at once, or fewer.
ErrorPair sphereInNest() {
  ErrorPair pair{"sphere-nest", "a ball of radius 0.4 m over the hollow between three of 0.5 m"};
  pair.isSceneCurved = true;
  const auto centre = [](int i) {
    const double angle = 2.0 * pi * i / 3.0;
    return 0.7 * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
  };
  pair.scene = [centre](std::uint32_t n) {
    const TriangleMesh ball = geodesicSphereMesh(0.5, n);
    const auto at = [&](int i) { return test::transformed(ball, 1.0, {{1.0, 0.0, 0.0, 0.0}, centre(i)}); };
    return test::joined(test::joined(at(0), at(1)), at(2));
  };
  pair.part = [](std::uint32_t n) { return geodesicSphereMesh(0.4, n); };
  pair.contacts = [centre](const RigidTransform& pose) -> Contacts {
    Contacts all;
    for (int i = 0; i < 3; ++i)
      all.push_back(sphereSphere({centre(i), 0.5}, {pose.translation, 0.4}));
    return all;
  };
  pair.proposePose = [](Random& random) -> RigidTransform {
    const glm::dvec3 place(between(random, -0.15, 0.15), between(random, -0.15, 0.15),
                           between(random, 0.6, 0.9));
    return {randomTurn(random), place};
  };
  return pair;
}

ErrorPair sphereOnTorus() {
  ErrorPair pair{"sphere-torus",
                 "a ball of radius 0.3 m around, above and in the hole of a ring (1 m, tube 0.25 m)"};
  pair.isSceneCurved = true;
  const Torus torus{glm::dvec3(0.0), kVertical, 1.0, 0.25};
  pair.scene = [](std::uint32_t n) { return fineTorusMesh(1.0, 0.25, 12, 4, n); };
  pair.part = [](std::uint32_t n) { return geodesicSphereMesh(0.3, n); };
  pair.contacts = [torus](const RigidTransform& pose) -> Contacts {
    return {torusSphere(torus, {pose.translation, 0.3})};
  };
  pair.proposePose = [](Random& random) -> RigidTransform {
    const double around = between(random, 0.0, 2.0 * pi), section = between(random, 0.0, 2.0 * pi);
    const double out = 0.25 + 0.3 + randomGap(random);
    const glm::dvec3 outward(std::cos(around), std::sin(around), 0.0);
    return {randomTurn(random),
            outward + out * (std::cos(section) * outward + std::sin(section) * kVertical)};
  };
  return pair;
}

ErrorPair sphereInBowl() {
  ErrorPair pair{"sphere-bowl", "a ball of radius 0.4 m in a bowl of 1 m: surfaces that nearly conform"};
  pair.isSceneCurved = true;
  pair.scene = [](std::uint32_t n) { return bowlMesh(1.0, 1.1, n); };
  pair.part = [](std::uint32_t n) { return geodesicSphereMesh(0.4, n); };
  pair.contacts = [](const RigidTransform& pose) -> Contacts {
    return {hollowSphere({glm::dvec3(0.0), 1.0}, {pose.translation, 0.4})};
  };
  pair.proposePose = [](Random& random) -> RigidTransform {
    // Toward the bottom, well below the rim.
    const double tilt = between(random, 0.0, radians(50.0)), around = between(random, 0.0, 2.0 * pi);
    const glm::dvec3 out(std::sin(tilt) * std::cos(around), std::sin(tilt) * std::sin(around),
                         -std::cos(tilt));
    return {randomTurn(random), (0.6 - randomGap(random)) * out};
  };
  return pair;
}

ErrorPair capsuleOnCapsule() {
  ErrorPair pair{"capsule-capsule", "two rods with round ends, crossed or end on"};
  pair.isSceneCurved = true;
  const Capsule scene{-0.5 * kVertical, 0.5 * kVertical, 0.2};
  pair.scene = [](std::uint32_t n) { return capsuleMesh(0.2, 0.5, n); };
  pair.part = [](std::uint32_t n) { return capsuleMesh(0.15, 0.4, n); };
  pair.contacts = [scene](const RigidTransform& pose) -> Contacts {
    return {capsuleCapsule(scene,
                           {pose.applyToPoint(-0.4 * kVertical), pose.applyToPoint(0.4 * kVertical), 0.15})};
  };
  pair.proposePose = [](Random& random) -> RigidTransform {
    const glm::dvec3 place(between(random, -1.0, 1.0), between(random, -1.0, 1.0),
                           between(random, -1.3, 1.3));
    return {randomTurn(random), place};
  };
  return pair;
}

ErrorPair torusOnTorus() {
  ErrorPair pair{"torus-torus",
                 "a ring (0.7 m, tube 0.2 m) beside or linked with another (1 m, tube 0.25 m)"};
  pair.isSceneCurved = true;
  pair.hasSaddles = true;
  const Torus scene{glm::dvec3(0.0), kVertical, 1.0, 0.25};
  pair.scene = [](std::uint32_t n) { return fineTorusMesh(1.0, 0.25, 12, 4, n); };
  pair.part = [](std::uint32_t n) { return fineTorusMesh(0.7, 0.2, 8, 4, n); };
  pair.contacts = [scene](const RigidTransform& pose) -> Contacts {
    return torusTorus(scene, {pose.translation, pose.rotation * kVertical, 0.7, 0.2});
  };
  pair.proposePose = [](Random& random) -> RigidTransform {
    return {randomTurn(random), between(random, 0.5, 2.4) * randomDirection(random)};
  };
  return pair;
}

/// Solids above the floor.
std::vector<ErrorPair> floorPairs() {
  const glm::dvec3 axes(0.6, 0.4, 0.25), box(0.8, 0.6, 0.4);
  const auto ball = [](const RigidTransform& pose) { return floorSphere({pose.translation, 0.5}); };
  const auto ellipsoid = [axes](const RigidTransform& pose) { return floorEllipsoid(axes, pose); };
  const auto cylinder = [](const RigidTransform& pose) { return floorCylinder(0.3, 1.0, pose); };
  const auto cone = [](const RigidTransform& pose) -> std::optional<TrueContact> {
    const std::optional<TrueContact> contact = floorCone(0.4, 0.8, pose);
    // Tilted by 180 degrees less its slope it lies on a line, and a mesh near that on either end.
    const double tilt = std::acos((pose.rotation * kVertical).z), slope = std::atan2(0.8, 0.4);
    return std::abs(tilt - (pi - slope)) < radians(5.0) ? std::nullopt : contact;
  };
  const auto boxContact = [box](const RigidTransform& pose) { return floorBox(box, pose); };
  const auto cylinderMesh = [](std::uint32_t n) { return fineCylinderMesh(0.3, 1.0, n); };
  const auto boxMesh = [box](std::uint32_t n) { return fineBoxMesh(box, n); };
  const auto tilted = [](double low, double high) {
    return [low, high](Random& random) { return randomTilt(random, radians(between(random, low, high))); };
  };
  std::vector<ErrorPair> pairs{
      onFloor(
          "sphere-plane", "a ball of radius 0.5 m above a floor",
          [](std::uint32_t n) { return geodesicSphereMesh(0.5, n); }, ball, randomTurn),
      onFloor(
          "ellipsoid-plane", "an ellipsoid of half axes 0.6, 0.4, 0.25 m above a floor",
          [axes](std::uint32_t n) { return ellipsoidMesh(axes, n); }, ellipsoid, randomTurn),
      onFloor("cylinder-tilted", "a cylinder (radius 0.3 m, height 1 m) on its rim above a floor",
              cylinderMesh, cylinder, tilted(10.0, 80.0)),
      onFloor("cylinder-lying", "the same lying: a line of minima", cylinderMesh, cylinder,
              tilted(90.0, 90.0)),
      onFloor(
          "cone-plane", "a cone (radius 0.4 m, height 0.8 m) on its apex or its rim above a floor",
          [](std::uint32_t n) { return fineConeMesh(0.4, 0.8, n); }, cone, tilted(5.0, 175.0)),
      onFloor("box-tilted", "a box on a corner above a floor", boxMesh, boxContact, tilted(10.0, 80.0)),
      onFloor("box-flat", "the same flat: a rectangle of minima", boxMesh, boxContact, tilted(0.0, 0.0))};
  for (ErrorPair& pair : pairs) {
    if (pair.name.starts_with("box")) pair.kind = PairKind::Exact;
  }
  return pairs;
}

bool isUsable(const Contacts& contacts) {
  const auto isNear = [](const TrueContact& c) { return c.distance <= kBeyond * kCutoff; };
  const auto isBad = [&](const TrueContact& c) {
    return isNear(c) &&
           (c.distance < kNearest * kCutoff || c.distance > kFarthest * kCutoff || !(c.spread <= kMaxSpread));
  };
  return std::any_of(contacts.begin(), contacts.end(), isNear) &&
         std::none_of(contacts.begin(), contacts.end(), isBad);
}

}  // namespace

std::vector<ErrorPair> errorPairs() {
  std::vector<ErrorPair> pairs{sphereOnSphere(), sphereOnTorus(),    sphereInBowl(),
                               sphereInNest(),   capsuleOnCapsule(), torusOnTorus()};
  std::vector<ErrorPair> floor = floorPairs();
  std::move(floor.begin(), floor.end(), std::back_inserter(pairs));
  return pairs;
}

std::vector<ErrorPose> randomPoses(const ErrorPair& pair, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<ErrorPose> poses;
  for (int proposal = 0; poses.size() < count; ++proposal) {
    if (proposal == kMaxProposals)
      throw Error(pair.name, "proposed poses do not do", "widen what its proposals are drawn from");
    const RigidTransform pose = pair.proposePose(random).normalized();
    Contacts contacts = pair.contacts(pose);
    if (!isUsable(contacts)) continue;
    std::erase_if(contacts, [&](const TrueContact& c) { return c.distance >= pair.cutoff; });
    poses.push_back({pose, std::move(contacts)});
  }
  return poses;
}

}  // namespace nearfit::bench
