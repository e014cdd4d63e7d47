#include "core/report/html/finding_views.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::finding_views_test {
namespace {

constexpr int kWidth = 560, kHeight = 420;

Part cube(const char* name, double size, const glm::dvec3& place) {
  return test::partOf(test::solidGeometryOf(test::boxMesh(glm::dvec3(size))), name,
                      {glm::dquat(1, 0, 0, 0), place});
}

/// A cube of 1 and one of 0.1 that stands in the middle of its upper face, or that far above it.
struct SmallOnLarge {
  explicit SmallOnLarge(double gap) {
    finding.pair.part = scene.add(cube("Large", 1.0, {0, 0, 0}));
    finding.pair.other = scene.add(cube("Small", 0.1, {0, 0, 0.55 + gap}));
    finding.verdict = gap > 0.0 ? PairVerdict::Near : PairVerdict::Touching;
    finding.distance = gap;
    finding.partPoint = {0, 0, 0.5};
    finding.otherPoint = {0, 0, 0.5 + gap};
  }
  Scene scene;
  PairFinding finding;
};

/// It was a picture of one face.
TEST(FindingViews, WherePartsTouchTheSmallerOneIsSeenAroundTheirPoint) {
  const SmallOnLarge touching(0.0);
  const FindingViews views = findingViews(touching.scene, touching.finding, kWidth, kHeight);
  ASSERT_TRUE(views.close);
  EXPECT_GE(views.close->view.extent, 0.1 * std::sqrt(3.0));
  EXPECT_LT(views.close->view.extent, 0.5 * views.whole.view.extent);
}

TEST(FindingViews, AGapIsSeenClose) {
  const SmallOnLarge near(1e-4);
  const FindingViews views = findingViews(near.scene, near.finding, kWidth, kHeight);
  ASSERT_TRUE(views.close);
  EXPECT_LT(views.close->view.extent, 0.1);
}

}  // namespace
}  // namespace nearfit::finding_views_test
