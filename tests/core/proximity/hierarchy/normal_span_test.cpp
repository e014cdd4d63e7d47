#include "core/mesh/normal_span.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/lmd_query.h"
#include "core/proximity/query/triangle_distance.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/trial_share.h"

namespace nearfit::normal_span_test {
namespace {

using test::BodyPair;

NormalConeTree spanTree(const TriangleMesh& mesh) {
  return NormalConeTree(mesh, {}, AcceptanceRule::NormalSpan);
}

/// A closed mesh whose vertex 0, at the origin, is a fan of four shallow ridges (along x and y, falling by
/// 0.2) and four steep valleys (between them, falling by 1).
TriangleMesh jaggedFan() {
  std::vector<glm::dvec3> points{{0, 0, 0}};
  std::vector<Triangle> faces;
  for (std::uint32_t k = 0; k < 8; ++k) {
    const double angle = 0.25 * std::numbers::pi * k;
    points.push_back({std::cos(angle), std::sin(angle), k % 2 == 0 ? -0.2 : -1.0});
    const std::uint32_t here = 1 + k, next = 1 + (k + 1) % 8;
    faces.push_back({0, here, next});
    faces.push_back({9, next, here});
  }
  points.push_back({0, 0, -3});
  return TriangleMesh(points, faces);
}

/// A thin cone whose tip stands 0.1 from the origin in the y-z plane, so much off z, and points at it.
RigidTransform needleAt(double angle) {
  const glm::dquat turn = glm::angleAxis(-angle, glm::dvec3(1, 0, 0));
  // coneMesh has its apex up at its height of 0.2: turned over, it points down.
  const glm::dquat over = glm::angleAxis(std::numbers::pi, glm::dvec3(1, 0, 0));
  return {turn * over, turn * glm::dvec3(0, 0, 0.3)};
}

bool hasTipToTip(const std::vector<Lmd>& lmds) {
  return std::ranges::any_of(lmds, [](const Lmd& lmd) {
    return std::abs(lmd.distance - 0.1) < 1e-9 && glm::length(lmd.scenePoint) < 1e-9;
  });
}

TEST(NormalSpan, JaggedFanCarriesMinimaByTheSpanThatAreNone) {
  const TriangleMesh fan = jaggedFan(), needle = test::coneMesh(0.01, 0.2, 16);
  const NormalConeTree exact(fan), span = spanTree(fan), tip(needle), spanTip = spanTree(needle);
  struct Case {
    double degrees;
    bool isMinimum, isInSpan;
  };
  // Towards the ridge along y, (0, sin a, cos a) leads away from it as long as tan a <= 0.2: 11.3 degrees.
  // The normals of the two faces beside that ridge are (+-0.2 c, 1 - 0.2 c, c), c = cos 45: between them, at
  // x = 0, the span reaches to tan a = (1 - 0.2 c) / c = 1.214: 50.5 degrees.
  for (const Case& c : {Case{5, true, true}, Case{11, true, true}, Case{12, false, true},
                        Case{30, false, true}, Case{50, false, true}, Case{51, false, false}}) {
    const RigidTransform pose = needleAt(c.degrees * std::numbers::pi / 180.0);
    EXPECT_EQ(hasTipToTip(test::allLmds(exact, tip, pose, 0.15)), c.isMinimum) << c.degrees;
    EXPECT_EQ(hasTipToTip(test::allLmds(span, spanTip, pose, 0.15)), c.isInSpan) << c.degrees;
  }
}

TEST(NormalSpan, OfConvexBodiesItIsTheExactSet) {
  const TriangleMesh meshes[] = {test::boxMesh({1, 2, 3}), test::icosphereMesh(1.0, 2),
                                 test::cylinderMesh(0.5, 2.0, 24), test::coneMesh(1.0, 1.0, 17)};
  std::mt19937_64 random(5);
  std::size_t compared = 0;
  for (const TriangleMesh& scene : meshes) {
    for (const TriangleMesh& part : meshes) {
      const NormalConeTree exactScene(scene), exactPart(part), spanScene = spanTree(scene),
                                                               spanPart = spanTree(part);
      for (int i = 0; i < 20; ++i) {
        const RigidTransform pose = test::poseNearContact({"", scene, part}, 0.2, random);
        const auto exact = test::allLmds(exactScene, exactPart, pose, 0.5);
        const auto span = test::allLmds(spanScene, spanPart, pose, 0.5);
        ASSERT_EQ(exact.size(), span.size());
        for (std::size_t k = 0; k < exact.size(); ++k)
          EXPECT_NEAR(exact[k].distance, span[k].distance, 1e-12);
        compared += exact.size();
      }
    }
  }
  EXPECT_GT(compared, 5 * std::size(meshes));
}

/// The rule as it is told, by brute force over pairs of triangles; shares nothing with the engine but the
/// mesh and the distance of two triangles.
class SpanOracle {
 public:
  explicit SpanOracle(const TriangleMesh& mesh) : mesh_(mesh) {
    for (const Triangle& t : mesh.triangles())
      normals_.push_back(glm::normalize(glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]))));
  }

  /// Whether d lies in the span of the normals of all faces that hold the point; within three of them to
  /// `slack`, which may be below zero.
  bool isInSpan(const glm::dvec3& point, const glm::dvec3& d, double slack) const {
    std::vector<glm::dvec3> around;
    for (std::size_t f = 0; f < normals_.size(); ++f) {
      if (holds(mesh_.triangles()[f], point)) around.push_back(normals_[f]);
    }
    // Caratheodory: in the cone of all is in the cone of some three, or nearly one or two of them.
    for (std::size_t i = 0; i < around.size(); ++i) {
      if (glm::distance(around[i], d) < kSame) return true;
      for (std::size_t j = i + 1; j < around.size(); ++j) {
        if (isBetween(around[i], around[j], d)) return true;
        for (std::size_t k = j + 1; k < around.size(); ++k) {
          const glm::dmat3 basis(around[i], around[j], around[k]);
          if (std::abs(glm::determinant(basis)) < 1e-9) continue;
          const glm::dvec3 w = glm::inverse(basis) * d;
          if (w.x > -slack && w.y > -slack && w.z > -slack) return true;
        }
      }
    }
    return false;
  }

 private:
  /// Directions of points that are a hundredth apart, and rounded.
  static constexpr double kSame = 1e-8;

  const glm::dvec3& at(std::uint32_t vertex) const { return mesh_.vertices()[vertex]; }

  bool holds(const Triangle& t, const glm::dvec3& p) const {
    const glm::dvec3 n = glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
    if (std::abs(glm::dot(glm::normalize(n), p - at(t[0]))) > 1e-9) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 &a = at(t[k]), &b = at(t[(k + 1) % 3]);
      if (glm::dot(glm::cross(b - a, p - a), glm::normalize(n)) < -1e-9) return false;
    }
    return true;
  }

  static bool isBetween(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& d) {
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine < 1e-9 || std::abs(glm::dot(across, d)) > kSame * sine) return false;
    return glm::dot(glm::cross(a, d), across) >= 0.0 && glm::dot(glm::cross(d, b), across) >= 0.0;
  }

  const TriangleMesh& mesh_;
  std::vector<glm::dvec3> normals_;
};

struct Pair {
  glm::dvec3 p, q;
};

/// All pairs within the cutoff that the rule accepts to `slack`.
std::vector<Pair> bruteForcePairs(const BodyPair& pair, const RigidTransform& pose, double cutoff,
                                  double slack) {
  const TriangleMesh part = test::transformed(pair.part, 1.0, pose);
  const SpanOracle scene(pair.scene), moved(part);
  std::vector<Pair> pairs;
  for (const Triangle& s : pair.scene.triangles()) {
    for (const Triangle& t : part.triangles()) {
      const auto xs = pair.scene.vertices(), xt = part.vertices();
      const TriangleCorners a{xs[s[0]], xs[s[1]], xs[s[2]]}, b{xt[t[0]], xt[t[1]], xt[t[2]]};
      const ClosestPoints gap = closestOfTriangles(a, b);
      const double distance = std::sqrt(gap.distanceSquared);
      if (!(distance > 1e-9) || distance > cutoff) continue;
      const glm::dvec3 d = (gap.b - gap.a) / distance;
      if (scene.isInSpan(gap.a, d, slack) && moved.isInSpan(gap.b, -d, slack))
        pairs.push_back({gap.a, gap.b});
    }
  }
  return pairs;
}

bool holds(const std::vector<Pair>& pairs, const Lmd& lmd) {
  return std::ranges::any_of(pairs, [&](const Pair& p) {
    return glm::distance(p.p, lmd.scenePoint) < 1e-7 && glm::distance(p.q, lmd.partPoint) < 1e-7;
  });
}

bool holds(const std::vector<Lmd>& lmds, const glm::dvec3& p, const glm::dvec3& q) {
  return std::ranges::any_of(lmds, [&](const Lmd& lmd) {
    return glm::distance(p, lmd.scenePoint) < 1e-7 && glm::distance(q, lmd.partPoint) < 1e-7;
  });
}

TEST(NormalSpan, JaggedBodiesHaveTheBruteForceSetOfTheRule) {
  std::mt19937_64 random(9);
  std::size_t found = 0, added = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const BodyPair pair{"stars", test::starMesh(seed, 1.0, 1, 0.4), test::starMesh(seed + 20, 1.0, 1, 0.4)};
    const NormalConeTree exactScene(pair.scene), exactPart(pair.part), scene = spanTree(pair.scene),
                                                                       part = spanTree(pair.part);
    for (std::size_t i = 0; i < 24 / test::kTrialShare; ++i) {
      const RigidTransform pose = test::poseNearContact(pair, 0.2, random);
      const auto span = test::allLmds(scene, part, pose, 0.5),
                 exact = test::allLmds(exactScene, exactPart, pose, 0.5);
      const auto atMost = bruteForcePairs(pair, pose, 0.501, 1e-6);
      for (const Lmd& lmd : span)
        EXPECT_TRUE(holds(atMost, lmd)) << "seed " << seed << " pose " << i;
      for (const Pair& p : bruteForcePairs(pair, pose, 0.499, -1e-6))
        EXPECT_TRUE(holds(span, p.p, p.q)) << "seed " << seed << " pose " << i;
      // Nothing exact is missed.
      for (const Lmd& lmd : exact)
        EXPECT_TRUE(holds(span, lmd.scenePoint, lmd.partPoint)) << "seed " << seed << " pose " << i;
      found += exact.size();
      added += span.size() - exact.size();
    }
  }
  // There is something to compare.
  EXPECT_GT(found, 30U / test::kTrialShare);
  EXPECT_GT(added, 8U / test::kTrialShare);
}

TEST(NormalSpan, FlatAndStraightVerticesAreNoFeatures) {
  // A subdivided box: vertices within its faces and along its edges have no span with an interior.
  const NormalSpanFeatures box = findNormalSpanFeatures(test::subdivided(test::boxMesh({1, 2, 3}), 2));
  EXPECT_EQ(box.features.vertices.size(), 8U);
  EXPECT_EQ(box.walls.size() * 2, box.features.neighbours.size());
}

TEST(NormalSpan, SaddlesAreKeptThatTheExactRuleDrops) {
  // The inner half of a torus is all saddles.
  const TriangleMesh torus = test::torusMesh(1.0, 0.4, 24, 16);
  EXPECT_LT(findFeatures(torus).vertices.size(), torus.vertices().size() * 3 / 4);
  EXPECT_EQ(findNormalSpanFeatures(torus).features.vertices.size(), torus.vertices().size());
}

TEST(NormalSpan, RimsOfOpenMeshesAreLeftOut) {
  const TriangleMesh square = test::squareMesh(1.0, 3);
  EXPECT_TRUE(findNormalSpanFeatures(square).features.edges.empty());
  EXPECT_FALSE(findFeatures(square).edges.empty());
}

}  // namespace
}  // namespace nearfit::normal_span_test
