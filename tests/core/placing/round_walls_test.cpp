#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "core/placing/cone_fit.h"
#include "core/placing/feature_pick.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/surface_hits.h"

namespace nearfit::round_walls_test {
namespace {

constexpr double kPi = std::numbers::pi, kDegree = kPi / 180.0;
constexpr double kHeight = 0.05, kInner = 0.012, kOuter = 0.03;
constexpr double kReach = 1e-5;

/// Angles of the lines along a wall, each facet up to `spread` wider or narrower than the mean one.
std::vector<double> linesOf(std::uint32_t facets, double spread, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> width(1.0 - spread, 1.0 + spread);
  std::vector<double> ends;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < facets; ++i)
    ends.push_back(sum += width(random));
  for (double& end : ends)
    end *= 2.0 * kPi / sum;
  return ends;
}

/// A tube about z from 0 to kHeight, its walls between lines at those angles, wider towards the top.
TriangleMesh tubeOf(const std::vector<double>& angles, double slope) {
  const double grown = slope * kHeight;
  const glm::dvec2 profile[] = {
      {kOuter, 0.0}, {kOuter + grown, kHeight}, {kInner + grown, kHeight}, {kInner, 0.0}};
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  const auto count = static_cast<std::uint32_t>(angles.size());
  for (const double angle : angles)
    for (const glm::dvec2& p : profile)
      vertices.emplace_back(p.x * std::cos(angle), p.x * std::sin(angle), p.y);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t j = (i + 1) % count, next = (k + 1) % 4;
      const std::uint32_t a = 4 * i + k, b = 4 * j + k, c = 4 * j + next, d = 4 * i + next;
      triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

RigidTransform somePose(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> in(-1.0, 1.0);
  return {glm::angleAxis(kPi * in(random), glm::normalize(glm::dvec3{in(random), in(random), 1.0})),
          glm::dvec3{in(random), in(random), in(random)}};
}

/// A tube as a file holds it, somewhere, and the points on a facet of its walls.
struct Tube {
  Tube(const std::vector<double>& angles, double halfAngle, std::uint64_t seed)
      : pose(somePose(seed)),
        slope(std::tan(halfAngle)),
        // Off the middle of the facet, off its diagonal.
        angle(0.7 * angles[0] + 0.3 * angles[1]),
        mesh(test::inSinglePrecision(test::transformed(tubeOf(angles, slope), 1.0, pose))) {}

  SurfaceHit on(bool isBore) const {
    const glm::dvec3 aside(std::cos(angle), std::sin(angle), 0.0), up(0.0, 0.0, 0.55 * kHeight);
    const glm::dvec3 from = (isBore ? 0.0 : 1.0) * aside + up, towards = (kInner + 0.001) * aside + up;
    return test::hitBy(mesh, pose.applyToPoint(from), pose.applyToPoint(towards));
  }
  /// Expects the axis, and where it lies, as the drawing has it.
  void expectAxis(const PickedFeature& picked, bool isBore) const {
    ASSERT_EQ(picked.feature.shape, FeatureShape::Axis);
    const glm::dvec3 axis = pose.applyToVector({0.0, 0.0, 1.0});
    EXPECT_NEAR(glm::length(glm::cross(picked.feature.direction, axis)), 0.0, 2e-5);
    EXPECT_NEAR(glm::length(picked.feature.direction), 1.0, 1e-12);
    EXPECT_NEAR(glm::distance(picked.feature.point, pose.applyToPoint({0.0, 0.0, 0.5 * kHeight})), 0.0, 3e-6);
    EXPECT_NEAR(picked.feature.radius, (isBore ? kInner : kOuter) + 0.5 * kHeight * slope, 2e-6);
    EXPECT_NEAR(picked.feature.halfAngle, std::atan(slope), 5e-5);
  }

  RigidTransform pose;
  double slope, angle;
  TriangleMesh mesh;
};

struct Cut {
  std::uint32_t facets;
  double spread;
};
/// The widest facet of eight uneven ones stays below 50 degrees.
constexpr Cut kCuts[] = {{8, 0.0},  {8, 0.05}, {12, 0.0}, {12, 0.3},
                         {16, 0.0}, {16, 0.5}, {64, 0.0}, {64, 0.6}};

// Fine cylinders had an axis; on a coarse or tapered wall there were only flat faces.
TEST(RoundWalls, CoarseAndTaperedWallsHaveTheirAxis) {
  std::uint64_t seed = 0;
  for (const Cut& cut : kCuts) {
    for (const double degrees : {0.0, 1.0, 5.0, 15.0, 30.0}) {
      for (int turn = 0; turn < 2; ++turn) {
        ++seed;
        const Tube tube(linesOf(cut.facets, cut.spread, seed), degrees * kDegree, seed);
        for (const bool isBore : {false, true}) {
          SCOPED_TRACE(testing::Message() << cut.facets << " facets, spread " << cut.spread << ", " << degrees
                                          << " degrees, seed " << seed << (isBore ? ", bore" : ""));
          const SurfaceHit hit = tube.on(isBore);
          for (const FeatureFilter filter : {FeatureFilter::Any, FeatureFilter::Axes}) {
            const auto picked = pickFeature(tube.mesh, hit, kReach, filter);
            ASSERT_TRUE(picked);
            tube.expectAxis(*picked, isBore);
            EXPECT_EQ(picked->feature.flats, 0U);
            EXPECT_EQ(picked->triangles.size(), 2U * cut.facets);
          }
          const auto face = pickFeature(tube.mesh, hit, kReach, FeatureFilter::Faces);
          ASSERT_TRUE(face);
          EXPECT_EQ(face->feature.shape, FeatureShape::Plane);
          EXPECT_EQ(face->triangles.size(), 2U);
        }
      }
    }
  }
}

TEST(RoundWalls, AConeWithATipHasItsAxis) {
  for (const std::uint32_t facets : {8U, 12U, 48U}) {
    for (const double degrees : {2.0, 10.0, 30.0}) {
      SCOPED_TRACE(testing::Message() << facets << " facets, " << degrees << " degrees");
      const RigidTransform pose = somePose(facets + static_cast<std::uint64_t>(degrees));
      const double radius = kHeight * std::tan(degrees * kDegree), angle = 2.0 * kPi * 0.3 / facets;
      const TriangleMesh mesh =
          test::inSinglePrecision(test::transformed(test::coneMesh(radius, kHeight, facets), 1.0, pose));
      const glm::dvec3 aside(std::cos(angle), std::sin(angle), 0.0), up(0.0, 0.0, 0.4 * kHeight);
      const auto picked =
          pickFeature(mesh, test::hitBy(mesh, pose.applyToPoint(aside + up), pose.applyToPoint(up)), kReach);
      ASSERT_TRUE(picked);
      ASSERT_EQ(picked->feature.shape, FeatureShape::Axis);
      const glm::dvec3 axis = pose.applyToVector({0.0, 0.0, 1.0});
      EXPECT_NEAR(glm::length(glm::cross(picked->feature.direction, axis)), 0.0, 5e-5);
      const glm::dvec3 middle = pose.applyToPoint({0.0, 0.0, 0.5 * kHeight});
      EXPECT_NEAR(glm::distance(picked->feature.point, middle), 0.0, 5e-6);
      EXPECT_NEAR(picked->feature.halfAngle, degrees * kDegree, 1e-4);
      EXPECT_EQ(picked->triangles.size(), facets);
    }
  }
}

TEST(RoundWalls, ThePrismOfANutHasFlatFacesAndItsAxisOnRequest) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Tube nut(linesOf(6, 0.0, seed), 0.0, seed);
    const SurfaceHit side = nut.on(false);
    const auto face = pickFeature(nut.mesh, side, kReach);
    ASSERT_TRUE(face);
    EXPECT_EQ(face->feature.shape, FeatureShape::Plane);
    EXPECT_EQ(face->triangles.size(), 2U);
    const auto axis = pickFeature(nut.mesh, side, kReach, FeatureFilter::Axes);
    ASSERT_TRUE(axis);
    nut.expectAxis(*axis, false);
    EXPECT_EQ(axis->feature.flats, 6U);
  }
}

TEST(RoundWalls, BarsOfFourFlatsHaveNoAxis) {
  const TriangleMesh box = test::boxMesh(glm::dvec3(0.1));
  const SurfaceHit side = test::hitBy(box, {1.0, 0.01, 0.013}, {0.0, 0.01, 0.013});
  EXPECT_EQ(pickFeature(box, side, kReach)->feature.shape, FeatureShape::Plane);
  EXPECT_FALSE(pickFeature(box, side, kReach, FeatureFilter::Axes));
  // Chamfered: eight corners on one circle.
  std::vector<double> lines;
  for (int quarter = 0; quarter < 4; ++quarter) {
    for (const double corner : {12.0, 78.0})
      lines.push_back((90.0 * quarter + corner) * kDegree);
  }
  const Tube bar(lines, 0.0, 3);
  EXPECT_EQ(pickFeature(bar.mesh, bar.on(false), kReach)->feature.shape, FeatureShape::Plane);
}

TEST(RoundWalls, EdgesBetweenFacetsAreNoneOfTheShapeButRimsAre) {
  const Tube tube(linesOf(8, 0.0, 1), 0.0, 4);
  const double line = 2.0 * kPi / 8.0;
  const auto hitAt = [&](double angle, double height) {
    const glm::dvec3 aside(std::cos(angle), std::sin(angle), 0.0), up(0.0, 0.0, height);
    return test::hitBy(tube.mesh, tube.pose.applyToPoint(aside + up), tube.pose.applyToPoint(up));
  };
  for (const FeatureFilter filter : {FeatureFilter::Any, FeatureFilter::Axes}) {
    const auto wall = pickFeature(tube.mesh, hitAt(line + 0.02, 0.5 * kHeight), 0.002, filter);
    ASSERT_TRUE(wall);
    tube.expectAxis(*wall, false);
  }
  const auto rim = pickFeature(tube.mesh, hitAt(line + 0.3, kHeight - 0.001), 0.002, FeatureFilter::Axes);
  ASSERT_TRUE(rim);
  ASSERT_EQ(rim->feature.shape, FeatureShape::Circle);
  EXPECT_NEAR(rim->feature.radius, kOuter, 1e-6);
  EXPECT_EQ(rim->vertices.size(), 9U);
}

TEST(ConeFit, PointsOnAConeGiveItFromARoughGuess) {
  const RigidTransform pose = somePose(7);
  const double slope = std::tan(12.0 * kDegree);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 9; ++i) {
    const double height = 0.3 * (i % 3), angle = 0.5 * i;
    const double radius = 0.4 + slope * height;
    points.push_back(pose.applyToPoint({radius * std::cos(angle), radius * std::sin(angle), height}));
  }
  const Cone guess{pose.applyToPoint({0.02, -0.03, 0.1}),
                   pose.applyToVector(glm::normalize(glm::dvec3(0.1, 0.05, 1.0))), 0.35, 0.1};
  const auto cone = fitCone(points, guess);
  ASSERT_TRUE(cone);
  EXPECT_NEAR(glm::length(glm::cross(cone->axis, pose.applyToVector({0.0, 0.0, 1.0}))), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(cone->slope), slope, 1e-9);
  EXPECT_NEAR(cone->halfAngle(), 12.0 * kDegree, 1e-9);
  for (const glm::dvec3& p : points)
    EXPECT_NEAR(cone->distanceFrom(p), 0.0, 1e-9);
  const std::vector<glm::dvec3> few(points.begin(), points.begin() + 5);
  EXPECT_FALSE(fitCone(few, guess));
}

/// The end of a pipe that blends into another one: its wall is cut into slivers between the rim and a wavy curve of
/// other angles, below which a fillet goes on smoothly.
struct BlendedPipe {
  static constexpr std::uint32_t kAtRim = 28, kAtCurve = 97;

  BlendedPipe() {
    const auto corner = [](double angle, double radius, double height) {
      return glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), height);
    };
    const auto rimAngle = [](std::uint32_t i) { return 2.0 * kPi * (i + 0.3) / kAtRim; };
    const auto curveAngle = [](std::uint32_t i) { return 2.0 * kPi * i / kAtCurve; };
    const auto curveHeight = [](double angle) {
      return kHeight * (0.3 + 0.25 * std::pow(std::sin(angle), 2));
    };
    std::vector<glm::dvec3> vertices;
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < kAtRim; ++i)
      vertices.push_back(corner(rimAngle(i), kRadius, kHeight));
    for (std::uint32_t row = 0; row <= kBlendRows; ++row) {
      const double turn = 0.5 * kPi * row / kBlendRows;
      for (std::uint32_t i = 0; i < kAtCurve; ++i) {
        const double angle = curveAngle(i);
        vertices.push_back(corner(angle, kRadius + kFillet * (1.0 - std::cos(turn)),
                                  curveHeight(angle) - kFillet * std::sin(turn)));
      }
    }
    const auto onCurve = [](std::uint32_t row, std::uint32_t i) {
      return kAtRim + row * kAtCurve + i % kAtCurve;
    };
    for (std::uint32_t r = 0, c = 0; r < kAtRim || c < kAtCurve;) {
      if (c == kAtCurve || (r < kAtRim && rimAngle(r) + kPi / kAtRim < curveAngle(c))) {
        triangles.push_back({r % kAtRim, onCurve(0, c), (r + 1) % kAtRim});
        ++r;
      } else {
        triangles.push_back({r % kAtRim, onCurve(0, c), onCurve(0, c + 1)});
        ++c;
      }
    }
    for (std::uint32_t row = 0; row < kBlendRows; ++row) {
      for (std::uint32_t i = 0; i < kAtCurve; ++i) {
        triangles.push_back({onCurve(row, i), onCurve(row + 1, i), onCurve(row + 1, i + 1)});
        triangles.push_back({onCurve(row, i), onCurve(row + 1, i + 1), onCurve(row, i + 1)});
      }
    }
    mesh = test::inSinglePrecision(
        test::transformed(TriangleMesh(std::move(vertices), std::move(triangles)), 1.0, pose));
  }

  static constexpr std::uint32_t kBlendRows = 6;
  static constexpr double kRadius = 0.012, kFillet = 0.002;
  RigidTransform pose = somePose(31);
  TriangleMesh mesh;
};

// The wall of a real pump's pipe was found in three of ten places alone.
TEST(RoundWalls, AWallOfSliversThatBlendsIntoAnotherHasItsAxisEverywhere) {
  const BlendedPipe pipe;
  const glm::dvec3 axis = pipe.pose.applyToVector({0.0, 0.0, 1.0});
  for (std::uint32_t t = 0; t < BlendedPipe::kAtRim + BlendedPipe::kAtCurve; ++t) {
    const Triangle& c = pipe.mesh.triangles()[t];
    const glm::dvec3 middle =
        (pipe.mesh.vertices()[c[0]] + pipe.mesh.vertices()[c[1]] + pipe.mesh.vertices()[c[2]]) / 3.0;
    const auto picked = pickFeature(pipe.mesh, {t, middle}, kReach, FeatureFilter::Axes);
    ASSERT_TRUE(picked && picked->feature.shape == FeatureShape::Axis) << t;
    EXPECT_NEAR(glm::length(glm::cross(picked->feature.direction, axis)), 0.0, 1e-4) << t;
    EXPECT_NEAR(picked->feature.radius, BlendedPipe::kRadius, 1e-3 * BlendedPipe::kRadius) << t;
    const glm::dvec3 off = picked->feature.point - pipe.pose.translation;
    EXPECT_NEAR(glm::length(off - glm::dot(off, axis) * axis), 0.0, 1e-3 * BlendedPipe::kRadius) << t;
  }
}

/// A wall about z of strips of random widths, every third a sliver, some of them cut by a slot at the lower end, whose
/// corners lie between the lines along the wall.
TriangleMesh slottedWall(std::uint64_t seed) {
  constexpr std::uint32_t kStrips = 36, kFirstCut = 4, kLastCut = 9, kPiece = 6;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> wide(0.15, 0.45), share(0.2, 0.3);
  std::vector<double> angles{0.0};
  for (std::uint32_t i = 0; i < kStrips; ++i)
    angles.push_back(angles.back() + (i % 3 == 2 ? 0.004 : wide(random)));
  const double turn = angles.back();
  std::vector<glm::dvec3> vertices;
  for (std::uint32_t i = 0; i < kStrips; ++i) {
    const double angle = angles[i] * 2.0 * kPi / turn;
    const bool isCut = i > kFirstCut && i <= kLastCut + 1;
    const glm::dvec3 aside(kOuter * std::cos(angle), kOuter * std::sin(angle), 0.0);
    vertices.push_back(aside + glm::dvec3(0.0, 0.0, isCut ? 0.3 * kHeight : 0.0));
    vertices.push_back(aside + glm::dvec3(0.0, 0.0, kHeight));
  }
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < kStrips; ++i) {
    const std::uint32_t j = (i + 1) % kStrips, top = 2 * i + 1;
    std::uint32_t from = 2 * i;
    if (i >= kFirstCut && i <= kLastCut) {
      double across = 0.0;
      for (int k = 0; k < 3; ++k) {
        across += share(random);
        glm::dvec3 p = glm::mix(vertices[top], vertices[2 * j + 1], across);
        p.z = (0.31 + 0.01 * k) * kHeight;
        const auto corner = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(p);
        triangles.push_back({top, from, corner});
        from = corner;
      }
    }
    // Of one of them only a piece is left, which ends between the lines.
    if (i != kPiece) triangles.insert(triangles.end(), {{top, from, 2 * j}, {top, 2 * j, 2 * j + 1}});
  }
  return test::inSinglePrecision(TriangleMesh(std::move(vertices), std::move(triangles)));
}

// Strips of a cylinder's wall that its ports cut were flat faces.
TEST(RoundWalls, StripsThatASlotCutsBelongToTheWall) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const TriangleMesh mesh = slottedWall(seed);
    for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", triangle " << t);
      const Triangle& c = mesh.triangles()[t];
      const glm::dvec3 middle = (mesh.vertices()[c[0]] + mesh.vertices()[c[1]] + mesh.vertices()[c[2]]) / 3.0;
      const auto picked = pickFeature(mesh, {t, middle}, 0.0);
      ASSERT_TRUE(picked);
      ASSERT_EQ(picked->feature.shape, FeatureShape::Axis);
      EXPECT_NEAR(std::abs(picked->feature.direction.z), 1.0, 1e-9);
      EXPECT_NEAR(picked->feature.radius, kOuter, 1e-6);
      EXPECT_EQ(picked->triangles.size(), mesh.triangles().size());
    }
  }
}

}  // namespace
}  // namespace nearfit::round_walls_test
