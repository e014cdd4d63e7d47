#include "core/proximity/hierarchy/normal_cone_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::normal_cone_tree_test {
namespace {

/// Roundings of a box or a limit in single precision, on meshes of size one.
constexpr double kRounding = 1e-6;

/// Calls back for each lane and each leaf below it.
void forEachLeafBelow(const NormalConeTree& tree,
                      const std::function<void(const NormalConeTree::Bound&, std::uint32_t leaf)>& visit) {
  std::function<void(std::uint32_t, std::vector<NormalConeTree::Bound>&)> descend =
      [&](std::uint32_t child, std::vector<NormalConeTree::Bound>& above) {
        if (NormalConeTree::isLeaf(child)) {
          for (const NormalConeTree::Bound& b : above)
            visit(b, child);
          return;
        }
        const NormalConeTree::Node& node = tree.nodes()[NormalConeTree::nodeIndex(child)];
        for (std::size_t lane = 0; lane < NormalConeTree::kWidth; ++lane) {
          if (node.child[lane] == NormalConeTree::kNoChild) continue;
          above.push_back(node.bound(lane));
          descend(node.child[lane], above);
          above.pop_back();
        }
      };
  std::vector<NormalConeTree::Bound> above;
  descend(0, above);
}

glm::dvec3 toVector(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

std::vector<glm::dvec3> cornersOf(const NormalConeTree& tree, std::uint32_t leaf) {
  const auto x = tree.positions();
  const std::uint32_t i = NormalConeTree::leafIndex(leaf);
  switch (NormalConeTree::leafKind(leaf)) {
    case FeatureKind::Vertex:
      return {x[tree.vertices()[i].vertex]};
    case FeatureKind::Edge:
      return {x[tree.edges()[i].v0], x[tree.edges()[i].v1]};
    default:
      const Triangle& t = tree.faces()[i].corners;
      return {x[t[0]], x[t[1]], x[t[2]]};
  }
}

/// Directions in which a feature carries minima, by the conditions of the definition: a face's normal,
/// and random directions that lead away from an edge's faces or from a vertex's neighbours.
std::vector<glm::dvec3> directionsOf(const NormalConeTree& tree, std::uint32_t leaf,
                                     std::mt19937_64& random) {
  const auto x = tree.positions();
  const std::uint32_t i = NormalConeTree::leafIndex(leaf);
  const std::vector<glm::dvec3> c = cornersOf(tree, leaf);
  if (c.size() == 3) return {glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]))};
  std::vector<glm::dvec3> away, out;
  if (c.size() == 2) {
    for (const std::uint32_t opposite : tree.edges()[i].opposite)
      away.push_back(x[opposite] - c[0]);
  } else {
    for (const std::uint32_t neighbour : tree.neighbours(tree.vertices()[i]))
      away.push_back(x[neighbour] - c[0]);
  }
  constexpr int kTries = 24;
  for (int n = 0; n < kTries; ++n) {
    glm::dvec3 d = test::randomRotation(random).rotation * glm::dvec3(0, 0, 1);
    if (c.size() == 2)
      d = glm::normalize(d - (c[1] - c[0]) * (glm::dot(d, c[1] - c[0]) / glm::dot(c[1] - c[0], c[1] - c[0])));
    bool isPolar = true;
    for (const glm::dvec3& a : away)
      isPolar = isPolar && glm::dot(d, a) <= 0.0;
    if (isPolar) out.push_back(d);
  }
  return out;
}

TEST(NormalConeTree, EachBoundHoldsTheFeaturesBelowIt) {
  std::size_t checked = 0;
  for (const double roughness : {0.05, 0.4, 0.8}) {
    const NormalConeTree tree(
        test::starMesh(static_cast<std::uint64_t>(100.0 * roughness), 1.0, 4, roughness));
    forEachLeafBelow(tree, [&](const NormalConeTree::Bound& b, std::uint32_t leaf) {
      for (const glm::dvec3& p : cornersOf(tree, leaf)) {
        const glm::dvec3 w = p - toVector(b.centre);
        EXPECT_LE(std::abs(glm::dot(w, toVector(b.n))), static_cast<double>(b.half[0]) + kRounding);
        EXPECT_LE(std::abs(glm::dot(w, toVector(b.u))), static_cast<double>(b.half[1]) + kRounding);
        EXPECT_LE(std::abs(glm::dot(w, toVector(b.v))), static_cast<double>(b.half[2]) + kRounding);
        ++checked;
      }
    });
  }
  EXPECT_GT(checked, 10000U);
}

TEST(NormalConeTree, EachBoundHoldsTheDirectionsOfTheFeaturesBelowIt) {
  // Rougher meshes have wider cones: bounded exactly, or by rays where they are narrow.
  std::mt19937_64 random(3);
  std::size_t checked = 0;
  for (const double roughness : {0.01, 0.05, 0.4, 0.8}) {
    const NormalConeTree tree(
        test::starMesh(static_cast<std::uint64_t>(100.0 * roughness), 1.0, 3, roughness));
    forEachLeafBelow(tree, [&](const NormalConeTree::Bound& b, std::uint32_t leaf) {
      for (const glm::dvec3& d : directionsOf(tree, leaf, random)) {
        const glm::dvec3 local(glm::dot(d, toVector(b.n)), glm::dot(d, toVector(b.u)),
                               glm::dot(d, toVector(b.v)));
        EXPECT_GE(local.x, static_cast<double>(b.leastN));
        EXPECT_LE(std::abs(local.y), static_cast<double>(b.mostU));
        EXPECT_LE(std::abs(local.z), static_cast<double>(b.mostV));
        ++checked;
      }
    });
  }
  EXPECT_GT(checked, 10000U);
}

TEST(NormalConeTree, EachNodeNamesTheLowestKindBelowIt) {
  // The box has no vertices below some nodes, once its faces are flats; the star is so large that its first levels are
  // built apart from the rest.
  std::array<std::size_t, 3> named{};
  for (const TriangleMesh& mesh :
       {test::starMesh(7, 1.0, 5, 0.1), test::subdivided(test::boxMesh({1, 2, 3}), 4)}) {
    const NormalConeTree tree(mesh);
    std::function<FeatureKind(std::uint32_t)> lowestBelow = [&](std::uint32_t child) {
      if (NormalConeTree::isLeaf(child)) return NormalConeTree::leafKind(child);
      FeatureKind lowest = FeatureKind::Face;
      for (const std::uint32_t c : tree.nodes()[NormalConeTree::nodeIndex(child)].child) {
        if (c == NormalConeTree::kNoChild) continue;
        const FeatureKind below = lowestBelow(c);
        EXPECT_EQ(NormalConeTree::lowestKind(c), below);
        lowest = std::min(lowest, below);
        if (!NormalConeTree::isLeaf(c)) ++named[static_cast<std::size_t>(below)];
      }
      return lowest;
    };
    lowestBelow(0);
  }
  for (const std::size_t count : named)
    EXPECT_GT(count, 0U);
}

}  // namespace
}  // namespace nearfit::normal_cone_tree_test
