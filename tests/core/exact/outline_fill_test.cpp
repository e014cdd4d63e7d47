#include "core/exact/outline_fill.h"

#include <vector>

#include <gtest/gtest.h>

namespace nearfit::outline_fill_test {
namespace {

struct Outline {
  std::vector<glm::dvec2> points;
  std::vector<std::array<std::uint32_t, 2>> segments;

  Outline& add(const std::vector<glm::dvec2>& curve) {
    const auto first = static_cast<std::uint32_t>(points.size()),
               count = static_cast<std::uint32_t>(curve.size());
    points.insert(points.end(), curve.begin(), curve.end());
    for (std::uint32_t i = 0; i < count; ++i)
      segments.push_back({first + i, first + (i + 1) % count});
    return *this;
  }
  double filled(FillRule rule) const {
    const FilledOutline fill = fillOutline(points, segments, rule);
    double area = 0.0;
    for (const auto& t : fill.triangles) {
      const glm::dvec2 a = fill.points[t[0]], b = fill.points[t[1]], c = fill.points[t[2]];
      const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      EXPECT_GE(twice, 0.0);
      area += 0.5 * twice;
    }
    return area;
  }
};

std::vector<glm::dvec2> square(double from, double to) {
  return {{from, from}, {to, from}, {to, to}, {from, to}};
}

TEST(OutlineFill, ASquareInASquareIsFilledOrAHoleByItsSense) {
  const std::vector<glm::dvec2> inner = square(1.0, 2.0), turned(inner.rbegin(), inner.rend());
  const Outline same = Outline().add(square(0.0, 3.0)).add(inner);
  const Outline hole = Outline().add(square(0.0, 3.0)).add(turned);
  EXPECT_DOUBLE_EQ(same.filled(FillRule::Wound), 9.0);
  EXPECT_DOUBLE_EQ(same.filled(FillRule::Odd), 8.0);
  EXPECT_DOUBLE_EQ(hole.filled(FillRule::Wound), 8.0);
  EXPECT_DOUBLE_EQ(hole.filled(FillRule::Odd), 8.0);
}

TEST(OutlineFill, CurvesThatCrossGetTheirCrossings) {
  const Outline two = Outline().add(square(0.0, 2.0)).add(square(1.0, 3.0));
  EXPECT_DOUBLE_EQ(two.filled(FillRule::Wound), 7.0);
  EXPECT_DOUBLE_EQ(two.filled(FillRule::Odd), 6.0);
}

TEST(OutlineFill, SegmentsThatLieOnEachOtherTakeEachOtherBack) {
  const Outline two = Outline().add({{0, 0}, {1, 0}, {1, 1}, {0, 1}}).add({{1, 0}, {2, 0}, {2, 1}, {1, 1}});
  EXPECT_DOUBLE_EQ(two.filled(FillRule::Wound), 2.0);
}

TEST(OutlineFill, PointsThatComeTwiceAndSegmentsOfNoLengthDoNoHarm) {
  const Outline outline = Outline().add({{0, 0}, {0, 0}, {2, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 2}});
  EXPECT_DOUBLE_EQ(outline.filled(FillRule::Wound), 4.0);
}

TEST(OutlineFill, WhatSpansNoAreaFillsNothing) {
  EXPECT_TRUE(fillOutline({}, {}, FillRule::Wound).triangles.empty());
  EXPECT_DOUBLE_EQ(Outline().add({{0, 0}, {1, 1}}).filled(FillRule::Wound), 0.0);
  EXPECT_DOUBLE_EQ(Outline().add({{0, 0}, {1, 1}, {2, 2}}).filled(FillRule::Odd), 0.0);
}

}  // namespace
}  // namespace nearfit::outline_fill_test
