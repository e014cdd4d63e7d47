#include "core/placing/seen_parts.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>

#include "tests/core/placing/projection_oracle.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::seen_parts_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// What is shown, and by whom it is looked at.
class Show {
 public:
  explicit Show(test::TestView view) : view_(view) { parts_.reserve(kMax); }

  PartId add(TriangleMesh mesh, const RigidTransform& worldFromPart, bool isOpaque = true,
             bool isCut = false) {
    Part& part = parts_.emplace_back(test::partOf(test::geometryOf(std::move(mesh)), "part", worldFromPart));
    part.id = static_cast<PartId>(parts_.size());
    shown_.push_back({{&part, worldFromPart}, isOpaque, isCut});
    return part.id;
  }
  std::vector<PartId> seenIn(const PixelBox& pixels,
                             const std::optional<CutPlane>& cut = std::nullopt) const {
    return partsSeenIn(shown_, view_.projection(), pixels, cut);
  }
  /// By a ray through each pixel, against each triangle.
  std::vector<PartId> metIn(const PixelBox& pixels, const std::optional<CutPlane>& cut = std::nullopt) const {
    std::vector<char> isMet(shown_.size(), 0);
    for (int y = pixels.lower.y; y <= pixels.upper.y; ++y) {
      for (int x = pixels.lower.x; x <= pixels.upper.x; ++x)
        meet(x, y, cut, isMet);
    }
    std::vector<PartId> met;
    for (std::size_t i = 0; i < shown_.size(); ++i) {
      if (isMet[i] != 0) met.push_back(shown_[i].placed.part->id);
    }
    return met;
  }

 private:
  static constexpr std::size_t kMax = 64;

  glm::dvec3 worldOf(int x, int y, double depth) const {
    const double aspect = test::kViewWidth / test::kViewHeight, half = view_.camera.halfHeight;
    const glm::dmat4 lens = view_.camera.isParallel
                                ? glm::ortho(-half * aspect, half * aspect, -half, half, -3.0, 3.0)
                                : glm::perspective(view_.camera.viewAngle, aspect, 1e-2, 1e1);
    const glm::dmat4 look =
        glm::lookAt(view_.camera.eye, view_.camera.eye + view_.camera.away, view_.camera.up);
    const glm::dvec4 p =
        glm::inverse(lens * look) *
        glm::dvec4(2.0 * x / test::kViewWidth - 1.0, 1.0 - 2.0 * y / test::kViewHeight, depth, 1.0);
    return glm::dvec3(p) / p.w;
  }
  /// Where a ray first meets what is left of a part, as a share of the ray; infinity: nowhere.
  static double shareOf(const ShownPart& part, const glm::dvec3& from, const glm::dvec3& way,
                        const std::optional<CutPlane>& cut) {
    double least = std::numeric_limits<double>::infinity();
    const TriangleMesh& mesh = part.placed.part->geometry->mesh;
    for (const Triangle& t : mesh.triangles()) {
      std::array<glm::dvec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = part.placed.worldFromPart.applyToPoint(mesh.vertices()[t[k]]);
      const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
      const double share = glm::dot(p[0] - from, normal) / glm::dot(way, normal);
      const glm::dvec3 at = from + share * way;
      if (!(share > 0.0) || share >= least) continue;
      if (part.isCut && cut && cut->heightOf(at) > 0.0) continue;
      bool isIn = true;
      for (std::size_t k = 0; k < 3; ++k)
        isIn = isIn && glm::dot(glm::cross(p[(k + 1) % 3] - p[k], at - p[k]), normal) >= 0.0;
      if (isIn) least = share;
    }
    return least;
  }
  void meet(int x, int y, const std::optional<CutPlane>& cut, std::vector<char>& isMet) const {
    const glm::dvec3 from = worldOf(x, y, -1.0), way = worldOf(x, y, 1.0) - from;
    std::vector<double> shares;
    double nearest = std::numeric_limits<double>::infinity();
    for (const ShownPart& part : shown_) {
      shares.push_back(shareOf(part, from, way, cut));
      if (part.isOpaque) nearest = std::min(nearest, shares.back());
    }
    for (std::size_t i = 0; i < shares.size(); ++i) {
      if (std::isfinite(shares[i]) && shares[i] <= nearest) isMet[i] = 1;
    }
  }

  test::TestView view_;
  std::vector<Part> parts_;
  std::vector<ShownPart> shown_;
};

RigidTransform at(double x, double y, double z) {
  return {{1.0, 0.0, 0.0, 0.0}, {x, y, z}};
}

const PixelBox kAll{{0, 0}, {899, 599}};

TEST(SeenParts, WhatLiesBehindIsNotSeenUnlessWhatIsBeforeShinesThrough) {
  for (const bool isParallel : {false, true}) {
    for (const bool isOpaque : {true, false}) {
      Show show(test::along({0, 1, 0}, {0, 0, 1}, isParallel));
      const PartId before = show.add(test::boxMesh(glm::dvec3(0.1)), at(0, -0.1, 0), isOpaque);
      const PartId behind = show.add(test::boxMesh(glm::dvec3(0.05)), at(0, 0.1, 0));
      if (isOpaque) {
        EXPECT_THAT(show.seenIn(kAll), ElementsAre(before));
      } else {
        EXPECT_THAT(show.seenIn(kAll), ElementsAre(before, behind));
      }
    }
  }
}

TEST(SeenParts, ABoxReachesToItsOutermostPixels) {
  // A millimetre a pixel, the part's left edge at the pixel 400 and its right one at 500.
  test::TestView view = test::along({0, 1, 0}, {0, 0, 1}, true);
  view.camera.halfHeight = 0.3;
  Show show(view);
  const PartId part = show.add(test::boxMesh(glm::dvec3(0.1)), at(0, 0, 0));
  EXPECT_THAT(show.seenIn({{100, 100}, {401, 500}}), ElementsAre(part));
  EXPECT_THAT(show.seenIn({{401, 500}, {100, 100}}), ElementsAre(part));
  EXPECT_THAT(show.seenIn({{100, 100}, {399, 500}}), IsEmpty());
  EXPECT_THAT(show.seenIn({{501, 100}, {600, 500}}), IsEmpty());
  EXPECT_THAT(show.seenIn({{450, 300}, {450, 300}}), ElementsAre(part));
}

TEST(SeenParts, BehindTheEyeNothingIsSeen) {
  Show show(test::along({0, 1, 0}));
  show.add(test::boxMesh(glm::dvec3(0.1)), at(0, -1.5, 0));
  // A floor under the eye, which is at y = -1: what lies before it is seen.
  const PartId floor = show.add(test::boxMesh({4.0, 4.0, 0.01}), at(0, 0, -0.1));
  EXPECT_THAT(show.seenIn(kAll), ElementsAre(floor));
  EXPECT_THAT(show.seenIn({{0, 0}, {899, 299}}), IsEmpty());
}

TEST(SeenParts, WhereAClosedPartIsCutItsInsideIsSeen) {
  Show show(test::along({0, 0, -1}, {0, 1, 0}));
  const PartId cut = show.add(test::boxMesh(glm::dvec3(0.1)), at(0, 0, 0), true, true);
  const PartId below = show.add(test::boxMesh(glm::dvec3(0.05)), at(0, 0, -0.2));
  const PartId spared = show.add(test::boxMesh(glm::dvec3(0.02)), at(0.03, 0.03, 0.2));
  const CutPlane half{{0, 0, 1}, 0.01};
  EXPECT_THAT(show.seenIn(kAll, half), ElementsAre(cut, spared));
  const CutPlane whole{{0, 0, 1}, -0.06};
  EXPECT_THAT(show.seenIn(kAll, whole), ElementsAre(below, spared));
}

TEST(SeenParts, AreThoseThatRaysMeet) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int round = 0; round < 12; ++round) {
    Show show(test::aslant(round % 2 == 1));
    for (int i = 0; i < 12; ++i) {
      const glm::dquat turn =
          glm::normalize(glm::dquat{unit(random), unit(random), unit(random), unit(random)});
      const RigidTransform pose{turn, 0.15 * glm::dvec3{unit(random), unit(random), unit(random)}};
      show.add(i % 2 == 0 ? test::boxMesh(glm::dvec3(0.06, 0.04, 0.09)) : test::tetrahedronMesh(0.05), pose,
               i % 3 != 0, i % 4 != 0);
    }
    const std::optional<CutPlane> cut =
        round % 3 == 0 ? std::nullopt
                       : std::optional(CutPlane{
                             glm::normalize(glm::dvec3{unit(random), unit(random), unit(random)}), 0.02});
    for (int box = 0; box < 6; ++box) {
      const glm::ivec2 corner(450 + static_cast<int>(250 * unit(random)),
                              300 + static_cast<int>(180 * unit(random)));
      const PixelBox pixels{corner, corner + glm::ivec2(10 * box, 60 - 10 * box)};
      EXPECT_EQ(show.seenIn(pixels, cut), show.metIn(pixels, cut));
    }
  }
}

}  // namespace
}  // namespace nearfit::seen_parts_test
