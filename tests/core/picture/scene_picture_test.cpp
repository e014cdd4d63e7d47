#include "core/picture/scene_picture.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/random_values.h"

namespace nearfit::scene_picture_test {
namespace {

constexpr Colour kRed{1.0F, 0.0F, 0.0F}, kGrey{0.6F, 0.6F, 0.6F};

int channelAt(const Picture& picture, double x, double y, int channel) {
  const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
  return picture.rgb.at(3 * (row * static_cast<std::size_t>(picture.width) + column) +
                        static_cast<std::size_t>(channel));
}

bool isWhite(const Picture& picture, double x, double y) {
  return channelAt(picture, x, y, 0) + channelAt(picture, x, y, 1) + channelAt(picture, x, y, 2) == 3 * 255;
}

void expectSame(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_NEAR(glm::distance(a, b), 0.0, 1e-12) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(ScenePicture, StandardViewsAreThoseOfTheWindow) {
  const PictureView front = viewFrom(PictureSide::Front), right = viewFrom(PictureSide::Right),
                    top = viewFrom(PictureSide::Top), iso = viewFrom(PictureSide::Isometric);
  expectSame(front.away(), {0, 1, 0});
  expectSame(front.right, {1, 0, 0});
  expectSame(right.away(), {-1, 0, 0});
  expectSame(right.right, {0, 1, 0});
  expectSame(top.away(), {0, 0, -1});
  expectSame(top.right, {1, 0, 0});
  expectSame(top.up, {0, 1, 0});
  expectSame(iso.away(), glm::normalize(glm::dvec3(-1, 1, -1)));
  EXPECT_GT(iso.up.z, 0.8);
}

TEST(ScenePicture, AViewAlongAnyDirectionHasPerpendicularAxes) {
  test::RandomValues random(5);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 away = i % 10 == 0 ? glm::dvec3(1e-9, 0.0, random.in(-1, 1)) : random.vector(1.0);
    const PictureView view = viewAlong(away);
    EXPECT_NEAR(glm::length(view.right), 1.0, 1e-12);
    EXPECT_NEAR(glm::length(view.up), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(view.right, view.up), 0.0, 1e-12);
    EXPECT_NEAR(glm::dot(view.away(), glm::normalize(away)), 1.0, 1e-12);
  }
}

TEST(ScenePicture, AFittedViewShowsAllPointsAndWastesLittle) {
  test::RandomValues random(6);
  for (int round = 0; round < 100; ++round) {
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 5; ++i)
      points.push_back(random.vector(3.0) + glm::dvec3(100, 0, 0));
    const PictureView view = fitted(viewAlong(random.vector(1.0)), points, 400, 300);
    double across = 0.0, up = 0.0;
    for (const glm::dvec3& p : points) {
      across = std::max(across, std::abs(glm::dot(p - view.centre, view.right)) / view.extent);
      up = std::max(up, std::abs(glm::dot(p - view.centre, view.up)) / (view.extent * 0.75));
    }
    EXPECT_LE(std::max(across, up), 0.5);
    EXPECT_GE(std::max(across, up), 0.4);
  }
  const std::vector<glm::dvec3> one{{7, 8, 9}};
  EXPECT_EQ(fitted(viewFrom(PictureSide::Front), one, 400, 300, 0.25).extent, 0.25);
  EXPECT_GT(fitted(viewFrom(PictureSide::Front), one, 400, 300).extent, 0.0);
}

TEST(ScenePicture, ASphereIsADiscThatIsLitByItsNormals) {
  constexpr int kSize = 300;
  const PartGeometryPtr sphere = test::geometryOf(test::icosphereMesh(1.0, 5));
  const DrawnShapes shapes(std::vector{sphere});
  test::RandomValues random(8);
  const RigidTransform pose{random.pose().rotation, glm::dvec3(3, 4, 5)};
  PictureView view = viewAlong(random.vector(1.0));
  view.centre = pose.translation;
  view.extent = 3.0;
  const Picture picture = drawn({view, {{sphere, pose, kGrey}}, {}}, shapes, kSize, kSize);
  const double radius = kSize / view.extent, middle = 0.5 * kSize;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double dx = (x + 0.5 - middle) / radius, dy = (middle - y - 0.5) / radius;
      const double away = std::hypot(dx, dy);
      if (away > 1.02) {
        ASSERT_TRUE(isWhite(picture, x, y)) << x << ' ' << y;
      } else if (away < 0.95) {
        const glm::dvec3 normal(dx, dy, std::sqrt(1.0 - away * away));
        const double brightness =
            kDarkest + (1.0 - kDarkest) * 0.5 * (1.0 + glm::dot(normal, pictureLight()));
        // Four levels: facets turn by some hundredths.
        ASSERT_NEAR(channelAt(picture, x, y, 1), 255.0 * 0.6 * brightness, 4.0) << x << ' ' << y;
      }
    }
  }
}

TEST(ScenePicture, TheInsideOfAnOpenMeshIsLitLikeItsOutside) {
  const PartGeometryPtr square = test::geometryOf(test::squareMesh(1.0, 2));
  const DrawnShapes shapes(std::vector{square});
  std::array<int, 2> levels{};
  for (const bool isFromBelow : {false, true}) {
    PictureView view = viewAlong({0, 0, isFromBelow ? 1.0 : -1.0});
    const Picture picture = drawn({view, {{square, {}, kGrey}}, {}}, shapes, 60, 60);
    levels[isFromBelow ? 1 : 0] = channelAt(picture, 25, 35, 0);
  }
  EXPECT_EQ(levels[0], levels[1]);
  const double facing = pictureLight().z;
  EXPECT_NEAR(levels[0], 255.0 * 0.6 * (kDarkest + (1.0 - kDarkest) * 0.5 * (1.0 + facing)), 1.0);
}

TEST(ScenePicture, SharpEdgesAreDrawnAndThoseBehindAreNot) {
  const PartGeometryPtr box = test::geometryOf(test::boxMesh({1, 1, 1}));
  const DrawnShapes shapes(std::vector{box});
  PictureView view = viewFrom(PictureSide::Front);
  view.extent = 2.0;
  // Turned by an eighth about z: one upright edge is in front in the middle, another behind it.
  const RigidTransform eighth{glm::dquat(std::cos(std::acos(-1.0) / 8), 0, 0, std::sin(std::acos(-1.0) / 8)),
                              {}};
  const Picture turned = drawn({view, {{box, eighth, kGrey}}, {}}, shapes, 200, 200);
  EXPECT_LT(channelAt(turned, 100, 100, 0), 80) << "the edge";
  EXPECT_GT(channelAt(turned, 110, 100, 0), 80) << "a face beside it";
  const Picture straight = drawn({view, {{box, {}, kGrey}}, {}}, shapes, 200, 200);
  EXPECT_GT(channelAt(straight, 100, 100, 0), 80) << "no edge along the diagonal of a face";
  EXPECT_TRUE(isWhite(straight, 40, 100));
  EXPECT_FALSE(isWhite(straight, 52, 100));
}

TEST(ScenePicture, AMarkInsideAPartIsSeenThroughIt) {
  const PartGeometryPtr box = test::geometryOf(test::boxMesh({1, 1, 1}));
  const DrawnShapes shapes(std::vector{box});
  PictureView view = viewFrom(PictureSide::Front);
  view.extent = 2.0;
  const ScenePicture scene{view,
                           {{box, {}, kGrey}},
                           {{{{-0.3, 0, 0.2}, {0.3, 0, 0.2}}, kRed, 3.0}, {{{0.0, -2.0, -0.2}}, kRed, 9.0}}};
  const Picture picture = drawn(scene, shapes, 200, 200);
  const int through = channelAt(picture, 100, 80, 0) - channelAt(picture, 100, 80, 1);
  EXPECT_GT(through, 100) << "two thirds red, one third grey";
  EXPECT_GT(channelAt(picture, 100, 80, 1), 10);
  EXPECT_EQ(channelAt(picture, 100, 120, 0), 255) << "the dot in front is all red";
  EXPECT_EQ(channelAt(picture, 100, 120, 1), 0);
}

TEST(ScenePicture, ThePictureDoesNotDependOnTheOrderOfTheParts) {
  test::RandomValues random(8);
  const std::vector<PartGeometryPtr> geometries{test::geometryOf(test::boxMesh({1.0, 2.0, 0.5})),
                                                test::geometryOf(test::icosphereMesh(0.8, 3))};
  const DrawnShapes shapes(geometries);
  ScenePicture scene;
  scene.view = viewAlong({0.3, 1.0, -0.4});
  scene.view.extent = 6.0;
  for (std::size_t i = 0; i < 40; ++i) {
    RigidTransform pose = random.pose();
    pose.translation = random.vector(4.0);
    const auto cover = i % 7 == 0 ? Raster::Cover::OneThird : Raster::Cover::Full;
    scene.parts.push_back({geometries[i % 2], pose, i % 3 == 0 ? kRed : kGrey, cover});
  }
  const Picture first = drawn(scene, shapes, 240, 180);
  for (int round = 0; round < 5; ++round) {
    for (std::size_t i = scene.parts.size() - 1; i > 0; --i)
      std::swap(scene.parts[i],
                scene.parts[static_cast<std::size_t>(random.in(0.0, static_cast<double>(i)))]);
    EXPECT_EQ(drawn(scene, shapes, 240, 180).rgb, first.rgb);
  }
}

TEST(ScenePicture, APartBehindAnotherIsLeftOutAndOneThatLooksOutIsNot) {
  constexpr int kSize = 200;
  const PartGeometryPtr wall = test::geometryOf(test::boxMesh({1.0, 0.1, 1.0})),
                        ball = test::geometryOf(test::icosphereMesh(0.2, 3));
  const DrawnShapes shapes(std::vector{wall, ball});
  ScenePicture scene;
  scene.view = viewFrom(PictureSide::Front);
  scene.view.extent = 2.0;
  scene.parts = {{wall, {}, kGrey}};
  const Picture alone = drawn(scene, shapes, kSize, kSize);
  scene.parts = {{ball, {{1, 0, 0, 0}, {0.2, 1.0, 0.0}}, kRed}, {wall, {}, kGrey}};
  EXPECT_EQ(drawn(scene, shapes, kSize, kSize).rgb, alone.rgb);
  // The wall ends 50 pixels from the middle, the ball three pixels farther.
  scene.parts[0].worldFromPart.translation.x = 0.33;
  const Picture both = drawn(scene, shapes, kSize, kSize);
  EXPECT_TRUE(isWhite(alone, 152.0, 100.0));
  EXPECT_FALSE(isWhite(both, 152.0, 100.0));
}

TEST(ScenePicture, PreparingShapesCanBeCancelled) {
  const PartGeometryPtr box = test::geometryOf(test::boxMesh({1, 1, 1}));
  EXPECT_THROW(DrawnShapes(std::vector{box, box}, [](double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace nearfit::scene_picture_test
