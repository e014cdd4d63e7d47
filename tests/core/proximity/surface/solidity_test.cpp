#include "core/proximity/surface/solidity.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/exact/triangle_predicates.h"
#include "core/proximity/surface/outer_windings.h"
#include "tests/exact/exact_meeting.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::solidity_test {
namespace {

/// A tube about a ring that closes after two rounds, the second shifted by less than its width: where the
/// rounds overlap it winds twice.
TriangleMesh twiceRoundTorus(std::uint32_t major, std::uint32_t minor) {
  std::vector<glm::dvec3> vertices;
  for (std::uint32_t i = 0; i < major; ++i) {
    const double u = 4.0 * std::numbers::pi * i / major;
    const double radius = 2.0 + 0.2 * std::cos(0.5 * u), height = 0.2 * std::sin(0.5 * u);
    for (std::uint32_t k = 0; k < minor; ++k) {
      const double v = 2.0 * std::numbers::pi * (k + 0.3) / minor;
      const double r = radius + 0.5 * std::cos(v);
      vertices.emplace_back(r * std::cos(u), r * std::sin(u), height + 0.5 * std::sin(v));
    }
  }
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < major; ++i) {
    const std::uint32_t a = i * minor, b = (i + 1) % major * minor;
    for (std::uint32_t k = 0; k < minor; ++k) {
      const std::uint32_t next = (k + 1) % minor;
      triangles.push_back({a + k, b + k, b + next});
      triangles.push_back({a + k, b + next, a + next});
    }
  }
  return TriangleMesh(std::move(vertices), std::move(triangles));
}

/// A ball finely meshed of which one vertex is moved to a place, given as a factor of where it was.
TriangleMesh ballWithOneVertexAt(double factor) {
  const TriangleMesh ball = test::icosphereMesh(1.0, 2);
  std::vector<glm::dvec3> vertices(ball.vertices().begin(), ball.vertices().end());
  vertices[0] *= factor;
  return TriangleMesh(std::move(vertices), {ball.triangles().begin(), ball.triangles().end()});
}

std::size_t crossingsOf(const TriangleMesh& mesh) {
  const MeshComponents pieces = piecesOf(mesh);
  return findSelfCrossings(mesh, pieces, PieceBoxes(mesh, pieces)).value().size();
}

/// Cubes of side 1, each moved by a hair from the one before, so that each overlaps all others.
TriangleMesh overlappingCubes(std::uint32_t count) {
  const TriangleMesh cube = test::boxMesh(glm::dvec3(1.0));
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const glm::dvec3& p : cube.vertices())
      vertices.push_back(p + 1e-7 * i);
    for (const Triangle& t : cube.triangles())
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return TriangleMesh(std::move(vertices), std::move(triangles));
}

TEST(Solidity, ClosedOutwardMeshesAreSolid) {
  for (const TriangleMesh& mesh :
       {test::boxMesh({1, 2, 3}), test::torusMesh(2, 0.5, 30, 20), test::tubeMesh(0.5, 1.0, 2.0, 12),
        test::cylinderMesh(1.0, 0.01, 500), test::starMesh(1, 1.0, 4, 0.3)}) {
    EXPECT_EQ(crossingsOf(mesh), 0U);
    EXPECT_TRUE(isSolidThroughout(mesh));
    EXPECT_FALSE(isSolidThroughout(test::turned(mesh)));
  }
  EXPECT_FALSE(isSolidThroughout(test::squareMesh(1.0, 3)));
}

TEST(Solidity, PiecesThatOverlapAreSolidAndACavityIsNot) {
  const TriangleMesh cube = test::boxMesh({1, 1, 1});
  EXPECT_TRUE(isSolidThroughout(test::joined(cube, test::boxMesh({1, 1, 1}, {0.4, 0.3, 0.2}))));
  EXPECT_TRUE(isSolidThroughout(test::joined(cube, cube))) << "twice in one place";
  EXPECT_TRUE(isSolidThroughout(test::joined(cube, test::boxMesh({0.5, 0.5, 0.5})))) << "one in the other";
  EXPECT_FALSE(isSolidThroughout(test::joined(cube, test::turned(test::boxMesh({0.5, 0.5, 0.5})))));
}

TEST(Solidity, APieceInsideOutIsNotSolidAlsoWhereItSharesAVertexWithALargerOne) {
  // Their volumes were once taken together: 1 - 1/1000 is positive.
  const TriangleMesh both = test::joined(test::boxMesh({1, 1, 1}),
                                         test::turned(test::boxMesh({0.1, 0.1, 0.1}, {0.55, 0.55, 0.55})));
  std::vector<glm::dvec3> vertices(both.vertices().begin(), both.vertices().end());
  std::vector<Triangle> triangles(both.triangles().begin(), both.triangles().end());
  std::size_t shared = 0;
  for (Triangle& t : triangles) {
    for (std::uint32_t& corner : t) {
      for (std::uint32_t first = 0; first < corner; ++first) {
        if (glm::distance(vertices[first], vertices[corner]) > 1e-12) continue;
        corner = first;
        ++shared;
      }
    }
  }
  ASSERT_GT(shared, 0U);
  EXPECT_FALSE(isSolidThroughout(TriangleMesh(std::move(vertices), std::move(triangles))));
}

TEST(Solidity, AFigureOfEightWithOneLobeInsideOutIsNotSolid) {
  for (const double scale : {0.9, 0.5, 0.1}) {
    const TriangleMesh mesh = test::figureOfEightMesh(scale);
    ASSERT_TRUE(mesh.topology().isClosed() && mesh.topology().isOriented());
    EXPECT_NEAR(test::windingNumber(mesh, {0.7, 0.1, 0.0}), 1.0, 1e-9);
    EXPECT_NEAR(test::windingNumber(mesh, {-0.7 * scale, 0.05 * scale, 0.0}), -1.0, 1e-9);
    EXPECT_GT(crossingsOf(mesh), 0U);
    EXPECT_FALSE(isSolidThroughout(mesh)) << scale;
    // Finer, some triangles cross nothing.
    EXPECT_FALSE(isSolidThroughout(test::subdivided(mesh, 3))) << scale;
  }
}

TEST(Solidity, ATubeThatOverlapsItselfAndWindsTwiceThereIsSolid) {
  const TriangleMesh mesh = twiceRoundTorus(120, 24);
  EXPECT_NEAR(test::windingNumber(mesh, {2.05, 0.01, 0.02}), 2.0, 1e-6);
  EXPECT_NEAR(test::windingNumber(mesh, {0.0, 0.0, 0.0}), 0.0, 1e-6);
  EXPECT_GT(crossingsOf(mesh), 0U);
  EXPECT_TRUE(isSolidThroughout(mesh));
  EXPECT_FALSE(isSolidThroughout(test::turned(mesh)));
}

TEST(Solidity, ASpikeThroughTheOtherSideIsNotSolidAndOneInsideIs) {
  // Moved in to -0.5 of where it was the vertex passes nothing; at -2 its faces come out on the far side,
  // inside out.
  EXPECT_EQ(crossingsOf(ballWithOneVertexAt(-0.5)), 0U);
  EXPECT_TRUE(isSolidThroughout(ballWithOneVertexAt(-0.5)));
  const TriangleMesh pierced = ballWithOneVertexAt(-2.0);
  const glm::dvec3 tip = pierced.vertices()[0];
  EXPECT_NEAR(test::windingNumber(pierced, 0.75 * tip), -1.0, 1e-6);
  EXPECT_GT(crossingsOf(pierced), 0U);
  EXPECT_FALSE(isSolidThroughout(pierced));
}

TEST(Solidity, MovedTurnedAndScaledMeshesAreJudgedAlike) {
  const RigidTransform motion{glm::normalize(glm::dquat(0.3, 0.5, -0.7, 0.2)), {100.0, -40.0, 7.0}};
  for (const double scale : {1e-3, 1.0, 1e3}) {
    EXPECT_TRUE(isSolidThroughout(test::transformed(twiceRoundTorus(60, 16), scale, motion))) << scale;
    EXPECT_FALSE(isSolidThroughout(test::transformed(test::figureOfEightMesh(0.5), scale, motion))) << scale;
    EXPECT_TRUE(isSolidThroughout(test::transformed(test::boxMesh({1, 1, 1e-3}), scale, motion))) << scale;
  }
}

TEST(Solidity, AFanOfNeedlesThatAllOverlapEndsSoon) {
  // Two discs of needles wound around their middle a thousand times: each box overlaps half of the others.
  constexpr std::uint32_t kCount = 40'000;
  std::vector<glm::dvec2> curve;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCount * 1001.0;
    curve.emplace_back(std::cos(angle), std::sin(angle));
  }
  EXPECT_FALSE(isSolidThroughout(test::prismOver(curve)));
}

// Pairs of triangles of different components were once looked at too, 2.9e10 of them here.
TEST(Solidity, CubesInOnePlaceTakeNoMoreWorkThanCubesApart) {
  constexpr std::uint32_t kCubes = 20'000;
  const TriangleMesh mesh = overlappingCubes(kCubes);
  const MeshComponents pieces = piecesOf(mesh);
  ASSERT_EQ(pieces.firstTriangle.size(), kCubes);
  const PieceBoxes boxes(mesh, pieces);
  std::uint64_t nodes = 0;
  std::size_t visits = 0;
  const Aabb all = mesh.bounds();
  for (std::uint32_t piece = 0; piece < kCubes; ++piece)
    nodes += boxes.forEachAt(piece, all, [&](std::uint32_t triangle) {
      EXPECT_EQ(pieces.pieceOf[triangle], piece);
      ++visits;
    });
  EXPECT_EQ(visits, mesh.triangles().size());
  EXPECT_LE(nodes, mesh.triangles().size());
  EXPECT_EQ(crossingsOf(mesh), 0U);
  EXPECT_TRUE(isSolidThroughout(mesh));
}

TEST(TrianglePredicates, TrianglesThatShareACornerOrASideMeetBeyondThemWhereTheyDo) {
  const glm::dvec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  // One corner: apart, through the face, along a side, in one plane beside and over each other.
  EXPECT_FALSE(doTrianglesMeetBeyond({o, x, y}, {o, -x, z}, 1));
  EXPECT_TRUE(doTrianglesMeetBeyond({o, x, y}, {o, x + y + z, x + y - z}, 1));
  EXPECT_FALSE(doTrianglesMeetBeyond({o, x, y}, {o, z - x - y, -z - x - y}, 1));
  EXPECT_TRUE(doTrianglesMeetBeyond({o, x, y}, {o, 2.0 * x, z}, 1));
  EXPECT_FALSE(doTrianglesMeetBeyond({o, x, y}, {o, -x, -y}, 1));
  EXPECT_FALSE(doTrianglesMeetBeyond({o, x, x + y}, {o, y, y - x}, 1));
  EXPECT_TRUE(doTrianglesMeetBeyond({o, x, y}, {o, x + y, 2.0 * y - x}, 1));
  EXPECT_TRUE(doTrianglesMeetBeyond({o, x, y}, {o, 0.1 * x + 0.2 * y, 0.2 * x + 0.1 * y}, 1)) << "within";
  // One side: a roof, a flat sheet, folded onto itself, and a little off that.
  EXPECT_FALSE(doTrianglesMeetBeyond({o, x, y}, {o, x, z}, 2));
  EXPECT_FALSE(doTrianglesMeetBeyond({o, x, y}, {o, x, -y}, 2));
  EXPECT_TRUE(doTrianglesMeetBeyond({o, x, y}, {o, x, y + x}, 2));
  EXPECT_FALSE(doTrianglesMeetBeyond({o, x, y}, {o, x, y + x + 1e-300 * z}, 2));
  EXPECT_TRUE(doTrianglesMeetBeyond({o, x, y}, {o, x, y}, 3));
}

TEST(TrianglePredicates, SidesOfATriangleAreToldToTheLastBit) {
  const TriangleCorners t{glm::dvec3(0.1, 0.1, 0.3), glm::dvec3(1.1, 0.1, 0.3), glm::dvec3(0.1, 1.1, 0.3)};
  EXPECT_EQ(sideOf({0.5, 0.5, std::nextafter(0.3, 1.0)}, t), 1);
  EXPECT_EQ(sideOf({0.5, 0.5, 0.3}, t), 0);
  EXPECT_EQ(sideOf({0.5, 0.5, std::nextafter(0.3, 0.0)}, t), -1);
  EXPECT_FALSE(hasNoArea(t));
  EXPECT_TRUE(hasNoArea({t[0], t[1], 0.5 * (t[0] + t[1])}));
}

}  // namespace
}  // namespace nearfit::solidity_test
