#include "tests/bench/paper_hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/triangle_distance.h"
#include "tests/bench/portable_random.h"
#include "tests/bench/query_method.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench::paper_hierarchy_test {
namespace {

using Corners = std::array<glm::dvec3, 3>;

Corners cornersOf(const TriangleMesh& mesh, std::size_t triangle, const RigidTransform& pose) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = pose.applyToPoint(mesh.vertices()[mesh.triangles()[triangle][k]]);
  return corners;
}

glm::dvec3 normalOf(const Corners& c) {
  return glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
}

/// What the rule says of one body's side of a pair, by definitions written anew: cones and spans from the mesh's
/// triangles alone, all triangles looked at.
class RuleBody {
 public:
  explicit RuleBody(const TriangleMesh& mesh) : mesh_(mesh) {
    for (std::size_t t = 0; t < mesh.triangles().size(); ++t)
      normals_.push_back(normalOf(cornersOf(mesh, t, {})));
  }

  /// Normals of all faces that have a point of the triangle's surface on them.
  std::vector<glm::dvec3> normalsAt(const glm::dvec3& point) const {
    std::vector<glm::dvec3> normals;
    for (std::size_t t = 0; t < normals_.size(); ++t) {
      if (distanceTo(cornersOf(mesh_, t, {}), point) < 1e-9) normals.push_back(normals_[t]);
    }
    return normals;
  }

  /// Angle between a direction and the axis of the triangle's cone, less the cone's half angle [rad].
  double beyondCone(std::size_t triangle, const glm::dvec3& direction) const {
    std::vector<glm::dvec3> held{normals_[triangle]};
    for (const std::uint32_t corner : mesh_.triangles()[triangle])
      held.push_back(vertexNormal(corner));
    glm::dvec3 axis(0.0);
    for (const glm::dvec3& n : held)
      axis += n;
    axis = glm::normalize(axis);
    double half = 0.0;
    for (const glm::dvec3& n : held)
      half = std::max(half, std::acos(std::min(1.0, glm::dot(n, axis))));
    return std::acos(std::clamp(glm::dot(direction, axis), -1.0, 1.0)) - half;
  }

 private:
  static double distanceTo(const Corners& c, const glm::dvec3& p) {
    // A triangle of no extent at the point.
    double best = std::numeric_limits<double>::infinity();
    const glm::dvec3 n = normalOf(c);
    const glm::dvec3 foot = p - glm::dot(p - c[0], n) * n;
    bool isInside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 &a = c[k], &b = c[(k + 1) % 3];
      isInside = isInside && glm::dot(glm::cross(b - a, foot - a), n) >= 0.0;
      const double s = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
      best = std::min(best, glm::distance(p, a + s * (b - a)));
    }
    return isInside ? std::min(best, glm::distance(p, foot)) : best;
  }

  glm::dvec3 vertexNormal(std::uint32_t vertex) const {
    glm::dvec3 sum(0.0);
    for (std::size_t t = 0; t < mesh_.triangles().size(); ++t) {
      const Triangle& corners = mesh_.triangles()[t];
      if (std::find(corners.begin(), corners.end(), vertex) == corners.end()) continue;
      const Corners c = cornersOf(mesh_, t, {});
      sum += glm::cross(c[1] - c[0], c[2] - c[0]);
    }
    return glm::normalize(sum);
  }

  const TriangleMesh& mesh_;
  std::vector<glm::dvec3> normals_;
};

/// Distance of a direction from the convex cone of some normals, by coordinate descent on |d - sum l_i n_i|^2 with
/// l >= 0.
double distanceFromSpan(const glm::dvec3& d, const std::vector<glm::dvec3>& normals) {
  std::vector<double> weights(normals.size(), 0.0);
  glm::dvec3 rest = d;
  for (int sweep = 0; sweep < 5000; ++sweep) {
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const double step = std::max(-weights[i], glm::dot(rest, normals[i]));
      weights[i] += step;
      rest -= step * normals[i];
    }
  }
  return glm::length(rest);
}

/// Tells what is in from what is out; where neither is sure, a pose is left out.
constexpr double kIn = 1e-8, kOut = 1e-5;

struct BruteForce {
  std::vector<double> distances;
  bool isSure = true, isTouching = false;
};

/// The rule over all pairs of triangles, each place once.
BruteForce bruteForce(const TriangleMesh& scene, const TriangleMesh& part, const RigidTransform& pose,
                      double cutoff, PaperRule rule) {
  const RuleBody a(scene), b(part);
  const RigidTransform back = pose.inverse();
  std::vector<std::pair<glm::dvec3, glm::dvec3>> places;
  BruteForce result;
  const auto note = [&result](double off) {
    if (off > kIn && off < kOut) result.isSure = false;
    return off <= kIn;
  };
  for (std::size_t i = 0; i < scene.triangles().size(); ++i) {
    for (std::size_t j = 0; j < part.triangles().size(); ++j) {
      const Corners onScene = cornersOf(scene, i, {}), onPart = cornersOf(part, j, pose);
      const ClosestPoints near = closestOfTriangles(TriangleCorners{onScene[0], onScene[1], onScene[2]},
                                                    TriangleCorners{onPart[0], onPart[1], onPart[2]});
      const double distance = std::sqrt(near.distanceSquared);
      if (distance < 1e-9) result.isTouching = true;
      if (distance > cutoff || distance < 1e-9) continue;
      const glm::dvec3 out = (near.b - near.a) / distance, in = back.applyToVector(-out);
      if (rule == PaperRule::NormalCones) {
        const bool isInA = note(a.beyondCone(i, out)), isInB = note(b.beyondCone(j, in));
        if (!isInA || !isInB) continue;
      }
      if (rule == PaperRule::NormalSpans) {
        const bool isInA = note(distanceFromSpan(out, a.normalsAt(near.a)));
        if (!isInA || !note(distanceFromSpan(in, b.normalsAt(back.applyToPoint(near.b))))) continue;
      }
      const bool isNew =
          rule == PaperRule::AllPairs || std::none_of(places.begin(), places.end(), [&](const auto& place) {
            return glm::distance(place.first, near.a) < 1e-9 && glm::distance(place.second, near.b) < 1e-9;
          });
      if (!isNew) continue;
      places.emplace_back(near.a, near.b);
      result.distances.push_back(distance);
    }
  }
  std::sort(result.distances.begin(), result.distances.end());
  return result;
}

void expectAgrees(PaperRule rule, std::uint32_t subdivisions, int poses) {
  std::mt19937_64 random(7);
  int compared = 0;
  std::size_t minima = 0;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const test::BodyPair pair{"stars", test::starMesh(seed, 1.0, subdivisions, 0.3),
                              test::starMesh(seed + 9, 1.0, subdivisions, 0.3)};
    const PaperHierarchy scene(pair.scene, rule), part(pair.part, rule);
    PaperQuery query(scene, part);
    for (int i = 0; i < poses; ++i) {
      // Half of them apart, so that there are poses without any interpenetration.
      RigidTransform pose = test::poseNearContact(pair, 0.1, random);
      if (i % 2 == 0) pose.translation = (1.9 + 0.4 * uniform(random)) * randomDirection(random);
      const double cutoff = 0.6;
      const BruteForce expected = bruteForce(pair.scene, pair.part, pose, cutoff, rule);
      const auto found = query.find(pose, cutoff);
      // Cones prune pairs that touch.
      if (rule == PaperRule::AllPairs) {
        EXPECT_EQ(query.isTouching(), expected.isTouching);
      }
      if (!expected.isSure) continue;
      ++compared;
      minima += expected.distances.size();
      ASSERT_EQ(found.size(), expected.distances.size()) << "seed " << seed << ", pose " << i;
      for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k].distance, expected.distances[k], 1e-9);
    }
  }
  EXPECT_GE(compared, 2 * poses);
  EXPECT_GE(minima, static_cast<std::size_t>(2 * poses));
}

TEST(PaperQuery, FindsWhatBruteForceOverAllPairsOfTrianglesFindsByCones) {
  expectAgrees(PaperRule::NormalCones, 1, 8);
}

TEST(PaperQuery, FindsWhatBruteForceOverAllPairsOfTrianglesFindsBySpans) {
  expectAgrees(PaperRule::NormalSpans, 1, 8);
}

TEST(PaperQuery, FindsAllPairsOfTrianglesWithinTheCutoff) {
  expectAgrees(PaperRule::AllPairs, 1, 8);
}

TEST(PaperQuery, StrictReadingIsTheRuleOfNormalSpansOnClosedMeshes) {
  // The engine's hierarchies of features, which share nothing with triangles, spheres and cones.
  std::mt19937_64 random(11);
  std::size_t minima = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const test::BodyPair pair{"stars", test::starMesh(seed, 1.0, 2, 0.25),
                              test::starMesh(seed + 5, 1.0, 2, 0.25)};
    const PaperHierarchy scene(pair.scene, PaperRule::NormalSpans), part(pair.part, PaperRule::NormalSpans);
    PaperQuery query(scene, part);
    const NormalConeTree sceneTree(pair.scene, {}, AcceptanceRule::NormalSpan),
        partTree(pair.part, {}, AcceptanceRule::NormalSpan);
    for (int i = 0; i < 20; ++i) {
      const RigidTransform pose{test::randomRotation(random).rotation,
                                (1.9 + 0.4 * uniform(random)) * randomDirection(random)};
      const auto found = query.find(pose, 0.3);
      if (query.isTouching()) continue;
      const std::vector<Lmd> expected = test::allLmds(sceneTree, partTree, pose, 0.3);
      ASSERT_EQ(found.size(), expected.size()) << "seed " << seed << ", pose " << i;
      for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k].distance, expected[k].distance, 1e-9);
      minima += found.size();
    }
  }
  EXPECT_GT(minima, 60U);
}

TEST(PaperQuery, OfABoxAboveABoxFindsTheCornerThatIsNearest) {
  const TriangleMesh floor = test::boxMesh({4.0, 4.0, 1.0}), box = test::boxMesh({1.0, 1.0, 1.0});
  const PaperHierarchy scene(floor, PaperRule::NormalSpans), part(box, PaperRule::NormalSpans);
  PaperQuery query(scene, part);
  // On its corner: half a diagonal of sqrt(3) below its centre.
  const glm::dvec3 corner = glm::normalize(glm::dvec3(1.0, 1.0, 1.0)), down(0.0, 0.0, -1.0);
  const glm::dquat turn =
      glm::angleAxis(std::acos(glm::dot(corner, down)), glm::normalize(glm::cross(corner, down)));
  const double height = 0.5 + std::sqrt(3.0) / 2.0 + 0.1;
  const auto found = query.find({turn, {0.3, 0.2, height}}, 0.15);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].distance, 0.1, 1e-12);
  EXPECT_EQ(found[0].partFeature.kind, PaperFeature::Kind::Vertex);
  EXPECT_EQ(found[0].sceneFeature.kind, PaperFeature::Kind::Face);
  EXPECT_NEAR(found[0].direction.z, 1.0, 1e-12);
  EXPECT_TRUE(query.find({turn, {0.3, 0.2, height}}, 0.09).empty());
}

TEST(PaperQuery, SaysThatBodiesTouch) {
  const PaperHierarchy box(test::boxMesh({1.0, 1.0, 1.0}), PaperRule::AllPairs);
  PaperQuery query(box, box);
  query.find({glm::angleAxis(0.3, glm::normalize(glm::dvec3(1, 2, 3))), {0.7, 0.1, 0.2}}, 0.1);
  EXPECT_TRUE(query.isTouching());
  query.find({{1, 0, 0, 0}, {3.0, 0.0, 0.0}}, 0.1);
  EXPECT_FALSE(query.isTouching());
}

TEST(NearestOfTriangles, IsThatOfTheEnginesTest) {
  std::mt19937_64 random(3);
  int touching = 0;
  for (int i = 0; i < 20'000; ++i) {
    glm::dvec3 a[3], b[3];
    const double spread = i % 2 == 0 ? 0.3 : 1.5;
    for (int k = 0; k < 3; ++k) {
      a[k] = uniform(random) * randomDirection(random);
      b[k] = uniform(random) * randomDirection(random) + glm::dvec3(spread, 0.0, 0.0);
    }
    const TrianglesNear near = nearestOf(a, b);
    const ClosestPoints expected =
        closestOfTriangles(TriangleCorners{a[0], a[1], a[2]}, TriangleCorners{b[0], b[1], b[2]});
    EXPECT_NEAR(near.distance, std::sqrt(expected.distanceSquared), 1e-12);
    touching += near.distance == 0.0 ? 1 : 0;
    if (near.distance > 0.0) {
      EXPECT_NEAR(glm::distance(near.a, near.b), near.distance, 1e-12);
    }
  }
  EXPECT_GT(touching, 1000);
  EXPECT_LT(touching, 10'000);
}

TEST(NormalSpan, OfThreeAxesIsTheirOctant) {
  const std::array<glm::dvec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::mt19937_64 random(5);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 d = randomDirection(random);
    EXPECT_EQ(isInSpan(d, axes), d.x >= 0.0 && d.y >= 0.0 && d.z >= 0.0) << d.x << " " << d.y << " " << d.z;
  }
}

TEST(NormalSpan, OfTwoNormalsIsTheirArcAndOfOneItself) {
  const std::array<glm::dvec3, 2> two{{{1, 0, 0}, {0, 1, 0}}};
  EXPECT_TRUE(isInSpan(glm::normalize(glm::dvec3(1, 2, 0)), two));
  EXPECT_FALSE(isInSpan(glm::normalize(glm::dvec3(1, 2, 0.01)), two));
  EXPECT_FALSE(isInSpan(glm::normalize(glm::dvec3(-1, 2, 0)), two));
  EXPECT_TRUE(isInSpan({1, 0, 0}, std::span(two).first(1)));
  EXPECT_FALSE(isInSpan(glm::normalize(glm::dvec3(1, 0.001, 0)), std::span(two).first(1)));
}

TEST(PaperHierarchy, HasEachTriangleInOneLeafAndHoldsWhatIsBelow) {
  const TriangleMesh mesh = test::starMesh(4, 1.0, 3, 0.3);
  const PaperHierarchy hierarchy(mesh, PaperRule::NormalCones);
  const auto nodes = hierarchy.nodes();
  ASSERT_EQ(nodes.size(), 2 * mesh.triangles().size() - 1);
  std::vector<int> leaves(mesh.triangles().size(), 0);
  // From every leaf's corners and normal up: parents by a walk from the root.
  std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> open{{0, {}}};
  while (!open.empty()) {
    auto [index, above] = open.back();
    open.pop_back();
    above.push_back(index);
    const PaperHierarchy::Node& node = nodes[index];
    if (!node.isLeaf()) {
      open.emplace_back(node.left, above);
      open.emplace_back(node.right, above);
      continue;
    }
    ++leaves[node.triangle];
    for (const std::uint32_t i : above) {
      for (const glm::dvec3& p : cornersOf(mesh, node.triangle, {}))
        EXPECT_LE(glm::distance(p, nodes[i].centre), nodes[i].radius * (1.0 + 1e-12));
      const double angle = std::acos(
          std::clamp(glm::dot(normalOf(cornersOf(mesh, node.triangle, {})), nodes[i].axis), -1.0, 1.0));
      EXPECT_LE(angle, std::acos(nodes[i].cosHalf) + 1e-7);
    }
  }
  EXPECT_EQ(std::count(leaves.begin(), leaves.end(), 1), static_cast<std::ptrdiff_t>(leaves.size()));
}

TEST(PaperHierarchy, OfCoincidentTrianglesStillEnds) {
  // Their middles are one, so that no mean splits them.
  std::vector<glm::dvec3> points;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 50; ++i) {
    points.insert(points.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const TriangleMesh mesh(points, triangles);
  EXPECT_EQ(PaperHierarchy(mesh, PaperRule::NormalSpans).nodes().size(), 99U);
}

TEST(PaperHierarchy, OfNoTrianglesFindsNothing) {
  const PaperHierarchy none(TriangleMesh{}, PaperRule::NormalSpans),
      box(test::boxMesh({1, 1, 1}), PaperRule::NormalSpans);
  EXPECT_TRUE(none.nodes().empty());
  EXPECT_TRUE(PaperQuery(none, box).find({}, 1.0).empty());
}

TEST(PaperHierarchy, TakesTheMiddleOfABoxForTheCentreOfMass) {
  // A cone's centre of mass is at a quarter of its height, the middle of its box at half.
  const PaperHierarchy cone(test::coneMesh(0.3, 1.0, 64), PaperRule::AllPairs);
  EXPECT_NEAR(cone.boxCentre().z, 0.5, 1e-3);
  EXPECT_NEAR(glm::length(glm::dvec2(cone.boxCentre())), 0.0, 1e-3);
}

TEST(PaperMethods, AreSlowOnesOfTheRegistryAndSeeTheNearestPairOfClosedMeshes) {
  const PreparedScene scene({"stars", test::starMesh(1, 0.5, 2, 0.2), test::starMesh(2, 0.5, 2, 0.2), {}, {}},
                            0.2);
  const RigidTransform pose{glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))), {0.97, 0.2, 0.1}};
  double nearest = 0.0;
  int papers = 0;
  for (const MethodEntry& method : allMethods()) {
    const Answer answer = method.make(scene)->query(pose);
    if (method.name == "nearfit-cold") nearest = answer.distance;
    if (!method.name.starts_with("paper-")) continue;
    ++papers;
    EXPECT_TRUE(isSlow(method.kind)) << method.name;
    EXPECT_GT(answer.count, 0U) << method.name;
    if (method.name != "paper-cones") {
      EXPECT_NEAR(answer.distance, nearest, 1e-9) << method.name;
    }
  }
  EXPECT_GT(nearest, 0.0);
  EXPECT_EQ(papers, 3);
}

}  // namespace
}  // namespace nearfit::bench::paper_hierarchy_test
