#include "core/placing/view_projection.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/core/placing/projection_oracle.h"

namespace nearfit::view_projection_test {
namespace {

const glm::dvec3 kPoints[] = {{0, 0, 0}, {0.1, 0.05, -0.07}, {-0.2, 0.1, 0.15}, {0.3, -0.3, 0.1}};

TEST(ViewProjection, PixelsAreThoseOfOpenGlsMatrices) {
  for (const bool isParallel : {false, true}) {
    const test::TestView view = test::aslant(isParallel);
    for (const glm::dvec3& point : kPoints) {
      const auto pixel = view.projection().pixelOf(point);
      ASSERT_TRUE(pixel);
      EXPECT_LT(glm::distance(*pixel, view.pixelOf(point)), 1e-9);
    }
  }
}

TEST(ViewProjection, ARayThroughAPointsPixelMeetsThePoint) {
  for (const bool isParallel : {false, true}) {
    const test::TestView view = test::aslant(isParallel);
    for (const glm::dvec3& point : kPoints) {
      const ViewRay ray = view.projection().rayThrough(view.pixelOf(point));
      EXPECT_NEAR(glm::length(ray.direction), 1.0, 1e-12);
      EXPECT_LT(glm::length(glm::cross(point - ray.origin, ray.direction)), 1e-12);
      EXPECT_GT(glm::dot(ray.direction, view.camera.away), 0.0);
    }
  }
}

TEST(ViewProjection, APixelIsAsWideAsTheMatricesHaveIt) {
  for (const bool isParallel : {false, true}) {
    const test::TestView view = test::aslant(isParallel);
    const ViewProjection projection = view.projection();
    for (const glm::dvec3& point : kPoints) {
      const double metres = projection.metresPerPixel(point);
      const glm::dvec2 next = view.pixelOf(point + metres * projection.right());
      EXPECT_NEAR(glm::distance(next, view.pixelOf(point)), 1.0, 1e-9);
    }
  }
}

TEST(ViewProjection, NothingBehindTheEyeHasAPixel) {
  const test::TestView view = test::aslant();
  const glm::dvec3 behind = view.camera.eye - 0.1 * view.camera.away;
  EXPECT_FALSE(view.projection().pixelOf(behind));
  EXPECT_FALSE(view.projection().pixelOf(view.camera.eye));
  EXPECT_EQ(view.projection().metresPerPixel(behind), 0.0);
}

TEST(ViewProjection, UpAlongTheSightStillGivesAFrame) {
  const ViewProjection projection = test::along({0, 0, -1}, {0, 0, 1}).projection();
  EXPECT_NEAR(glm::length(projection.right()), 1.0, 1e-12);
  EXPECT_NEAR(glm::length(projection.up()), 1.0, 1e-12);
  EXPECT_NEAR(glm::dot(projection.right(), projection.up()), 0.0, 1e-12);
}

}  // namespace
}  // namespace nearfit::view_projection_test
