#include "tests/bench/feel_tessellation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>

#include "core/haptics/virtual_coupling.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/error_shapes.h"
#include "tests/bench/feel_certified.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/proxy_walk.h"

namespace nearfit::bench {
namespace {

using std::numbers::pi;

constexpr std::size_t kMaxTicks = 3000;
/// Ticks without motion after which it is at rest: a pose that is the same twice could be waiting for a list.
constexpr std::size_t kStillTicks = 30;
/// Vertices on a surface are on it to this [m].
constexpr double kOnSurface = 1e-9;

/// How far facets of a tessellated sphere about the origin are from it.
double sphereSagitta(const TriangleMesh& mesh, double radius) {
  double most = 0.0;
  const auto x = mesh.vertices();
  for (const Triangle& t : mesh.triangles()) {
    const bool isOnSphere = std::ranges::all_of(
        t, [&](std::uint32_t v) { return std::abs(glm::length(x[v]) - radius) < kOnSurface; });
    if (!isOnSphere) continue;
    const glm::dvec3 n = glm::normalize(glm::cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]));
    most = std::max(most, radius - std::abs(glm::dot(n, x[t[0]])));
  }
  return most;
}

/// How far chords of a tessellated cylinder about z are from it.
double cylinderSagitta(const TriangleMesh& mesh, double radius) {
  double most = 0.0;
  const auto fromAxis = [](const glm::dvec3& p) { return glm::length(glm::dvec2(p)); };
  for (const MeshEdge& e : mesh.edges()) {
    const glm::dvec3 &a = mesh.vertices()[e.v0], &b = mesh.vertices()[e.v1];
    if (std::abs(fromAxis(a) - radius) < kOnSurface && std::abs(fromAxis(b) - radius) < kOnSurface)
      most = std::max(most, radius - fromAxis(0.5 * (a + b)));
  }
  return most;
}

/// Of a chord of an arc of that many to the whole circle.
double sagitta(double radius, double segments) {
  return radius * (1.0 - std::cos(pi / segments));
}

RigidTransform at(const glm::dvec3& translation, const glm::dquat& rotation = {1.0, 0.0, 0.0, 0.0}) {
  return {rotation, translation};
}

RestScene ballInBowl() {
  constexpr double kBowl = 0.5, kBall = 0.2, kFree = kBowl - kBall - kRestMargin;
  // Aslant, so that it is not over a vertex.
  const glm::dvec3 down = glm::normalize(glm::dvec3(0.26, 0.22, -0.94));
  return {"ball-bowl",
          "a ball of 0.2 m pressed into a bowl of 0.5 m",
          [](std::uint32_t n) { return bowlMesh(kBowl, 0.6, n); },
          [](std::uint32_t n) { return geodesicSphereMesh(kBall, 2 * n); },
          at(0.15 * down),
          at((kFree + kRestPress) * down),
          at(kFree * down),
          [](const TriangleMesh& scene, const TriangleMesh& part) {
            return sphereSagitta(scene, kBowl) + sphereSagitta(part, kBall);
          }};
}

RestScene cylinderOnFloor() {
  constexpr double kRadius = 0.1, kRest = kRadius + kRestMargin;
  // Lying, turned about its axis so that it stands on no chord.
  const glm::dquat lying =
      glm::angleAxis(0.5 * pi, glm::dvec3(0, 1, 0)) * glm::angleAxis(0.1, glm::dvec3(0, 0, 1));
  return {"cylinder-floor",
          "a cylinder of 0.1 m that lies on a floor",
          [](std::uint32_t) { return test::boxMesh({2.0, 2.0, 0.2}, {0.0, 0.0, -0.1}); },
          [](std::uint32_t n) { return fineCylinderMesh(kRadius, 0.4, n); },
          at({0.0, 0.0, 0.15}, lying),
          at({0.0, 0.0, kRest - kRestPress}, lying),
          at({0.0, 0.0, kRest}, lying),
          [](const TriangleMesh&, const TriangleMesh& part) { return cylinderSagitta(part, kRadius); }};
}

RestScene pegInTube() {
  constexpr double kBore = 0.15, kPeg = 0.12, kFree = kBore - kPeg - kRestMargin;
  const glm::dvec3 aside(std::cos(0.47), std::sin(0.47), 0.0);
  return {"peg-tube", "a peg of 0.12 m pressed aside in a tube of 0.15 m",
          // Strips from end to end: four times as many are four times the triangles.
          [](std::uint32_t n) { return test::tubeMesh(kBore, 0.25, 0.6, 12 * n * n); },
          [](std::uint32_t n) { return fineCylinderMesh(kPeg, 0.3, n); }, at({}),
          at((kFree + kRestPress) * aside), at(kFree * aside),
          [](const TriangleMesh& scene, const TriangleMesh& part) {
            return cylinderSagitta(scene, kBore) + cylinderSagitta(part, kPeg);
          }};
}

RestScene boxOnSlab() {
  constexpr double kRest = 0.1 + kRestMargin;
  return {"box-slab",
          "a box pressed flat on a slab: the meshes are the solids",
          [](std::uint32_t n) {
            return test::transformed(fineBoxMesh({1.0, 1.0, 0.2}, n), 1.0, at({0.0, 0.0, -0.1}));
          },
          [](std::uint32_t n) { return fineBoxMesh({0.4, 0.3, 0.2}, n); },
          at({0.0, 0.0, 0.15}),
          at({0.03, 0.02, kRest - kRestPress}),
          at({0.03, 0.02, kRest}),
          [](const TriangleMesh&, const TriangleMesh&) { return 0.0; }};
}

RestScene ringOnPeg() {
  constexpr double kRing = 0.2, kTube = 0.05, kPeg = 0.1, kFree = kRing - kTube - kPeg - kRestMargin;
  constexpr std::uint32_t kAround = 12, kAcross = 6;
  const glm::dvec3 aside(std::cos(0.6), std::sin(0.6), 0.0);
  return {"ring-peg",
          "a ring (0.2 m, tube 0.05 m) drawn against a peg of 0.1 m through it",
          [](std::uint32_t n) { return fineCylinderMesh(kPeg, 1.0, n); },
          [](std::uint32_t n) { return fineTorusMesh(kRing, kTube, kAround, kAcross, n); },
          at({}),
          at((kFree + kRestPress) * aside),
          at(kFree * aside),
          [](const TriangleMesh& scene, const TriangleMesh& part) {
            const double fineness =
                std::sqrt(static_cast<double>(part.triangles().size()) / (2.0 * kAround * kAcross));
            return cylinderSagitta(scene, kPeg) + sagitta(kRing + kTube, kAround * fineness) +
                   sagitta(kTube, kAcross * fineness);
          }};
}

double distanceInMetric(const MassMetric& metric, const RigidTransform& from, const RigidTransform& to) {
  const glm::dvec3 turn = metric.principalFromWorld(from) * turnBetween(from.rotation, to.rotation);
  const glm::dvec3 shift = to.translation - from.translation, turned = metric.gyration * turn;
  return std::sqrt(glm::dot(shift, shift) + glm::dot(turned, turned));
}

}  // namespace

std::vector<RestScene> restScenes() {
  return {ballInBowl(), cylinderOnFloor(), pegInTube(), boxOnSlab(), ringOnPeg()};
}

RestResult restOf(const RestScene& scene, std::uint32_t fineness) {
  RestResult result;
  result.fineness = fineness;
  const TriangleMesh sceneMesh = scene.scene(fineness), partMesh = scene.part(fineness);
  result.triangles = sceneMesh.triangles().size() + partMesh.triangles().size();
  result.meshDifference = scene.meshDifference(sceneMesh, partMesh);
  test::ProxyWalk walk({{sceneMesh, {}}}, partMesh, scene.start, {.margin = kRestMargin});
  std::size_t still = 0;
  while (result.ticks < kMaxTicks && still < kStillTicks) {
    const RigidTransform before = walk.pose();
    walk.lead(scene.hand);
    result.poses.push_back(walk.pose());
    ++result.ticks;
    const bool isSame = before == walk.pose();
    still = isSame ? still + 1 : 0;
  }
  result.isResting = still == kStillTicks;
  result.pose = walk.pose();
  const MassMetric& metric = walk.scene().metric;
  const double widest = std::max({metric.gyration.x, metric.gyration.y, metric.gyration.z});
  result.wrench =
      couplingWrench({.stiffness = kRestStiffness, .rotationalStiffness = kRestStiffness * widest * widest},
                     metric, walk.scene().centreInPart, {scene.hand, {}}, {result.pose, {}});
  result.gyration = metric.gyration;
  result.bodies = std::make_shared<const ServoScene>(walk.scene());
  result.fromFormula = distanceInMetric(metric, result.pose, scene.rest);
  result.fromHand = distanceInMetric(metric, result.pose, scene.hand);
  return result;
}

/// Let e be how far the meshes are from the solids, and D how far the hand is from where it rests on the
/// solids. A pose free of the meshes is free of the solids once it is drawn back by e; that is then at most
/// D + 2 e from the hand, as the resting pose on the meshes is at most D + e from it. Where what is free is
/// convex, the nearest pose is nearer than any other by Pythagoras: off by x, it is at least
/// sqrt(D^2 + x^2) from the hand. So x^2 <= (D + 2 e)^2 - D^2, and e for drawing back. Across the way that it
/// is pressed a pose can be off by more than the meshes, then: a part finds the lowest place between facets,
/// half an edge away. What decides is the facets' slope, which falls with the length of edges as x does, not
/// their distance, which falls with its square as e does. The wrench as a whole, in the metric's dual
/// (torques over gyrations), is stiffness times the distance from the hand: it is off by no more than e times
/// that.
double restBound(double meshDifference) {
  const double e = meshDifference;
  return e + std::sqrt(4.0 * e * kRestPress + 4.0 * e * e);
}

/// Of that distance x as much as all may be a turn t: |g t| <= x. The coupling's load is k g^2 t along each
/// principal axis, no longer than k g_max x, and the torque is longer than its load by (phi / 2) / sin(phi /
/// 2) at most, phi being the angle, no more than x / g_min (torqueOf in virtual_coupling.cpp).
double restTorqueBound(double meshDifference, const glm::dvec3& gyration) {
  const double x = restBound(meshDifference);
  const double angle = x / std::min({gyration.x, gyration.y, gyration.z});
  if (angle >= pi) return std::numeric_limits<double>::infinity();
  const double bend = angle > 0.0 ? 0.5 * angle / std::sin(0.5 * angle) : 1.0;
  return kRestStiffness * std::max({gyration.x, gyration.y, gyration.z}) * x * bend;
}

std::vector<FeelRow> tessellationRows(const RestScene& scene, std::span<const std::uint32_t> finenesses) {
  std::vector<FeelRow> rows;
  for (const std::uint32_t fineness : finenesses) {
    const RestResult rest = restOf(scene, fineness);
    const std::string run = fmt::format("x{} ({} triangles)", fineness * fineness, rest.triangles);
    const auto add = [&](const char* quantity, double value) {
      rows.push_back(feelRow("tessellation", scene.name, run, quantity, std::vector{value}));
    };
    add("meshes off solids [m]", rest.meshDifference);
    add("pose off formula [m]", rest.fromFormula);
    add("way to hand off [m]", std::abs(rest.fromHand - kRestPress));
    add("force [N]", glm::length(rest.wrench.force));
    add("torque [N m]", glm::length(rest.wrench.torque));
    add("torque at most [N m]", restTorqueBound(rest.meshDifference + kRestSag, rest.gyration));
    add("ticks until rest", static_cast<double>(rest.ticks));
    rows.push_back(certifiedRow("tessellation", scene.name, run, *rest.bodies, rest.poses));
  }
  return rows;
}

}  // namespace nearfit::bench
