#include "core/math/box_pairs.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random_values.h"

namespace nearfit::box_pairs_test {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

bool overlap(const Aabb& a, const Aabb& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return false;
  }
  return true;
}

Pairs byAllPairs(const std::vector<Aabb>& boxes) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (overlap(boxes[i], boxes[j])) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

void fill(BoxPairs& finder, const std::vector<Aabb>& boxes) {
  finder.clear();
  for (const Aabb& box : boxes)
    finder.add(box);
  finder.build();
}

/// Sorted; a pair that comes twice is in it twice.
Pairs pairsOf(const BoxPairs& finder) {
  Pairs pairs;
  finder.forEachPair([&](std::uint32_t i, std::uint32_t j) { pairs.emplace_back(std::minmax(i, j)); });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// @param grid  Coordinates are rounded to it, so that boxes coincide and touch; 0 for none.
std::vector<Aabb> randomBoxes(std::size_t count, double size, double grid, test::RandomValues& random) {
  std::vector<Aabb> boxes;
  const auto rounded = [&](glm::dvec3 p) {
    for (int axis = 0; axis < 3 && grid > 0.0; ++axis)
      p[axis] = grid * std::round(p[axis] / grid);
    return p;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 corner = random.vector(1.0);
    Aabb box;
    box.add(rounded(corner));
    // Of all sizes, flat and thin ones among them.
    const double scale = size * std::pow(10.0, random.in(-3.0, 0.0));
    box.add(rounded(corner + random.vector(scale) * glm::dvec3(1.0, random.flip(0.3) ? 0.0 : 1.0, 1.0)));
    boxes.push_back(box);
  }
  return boxes;
}

TEST(BoxPairs, FindsEachPairOnceAndNoOther) {
  test::RandomValues random(3);
  BoxPairs finder(700);
  for (const std::size_t count : {0U, 1U, 2U, 8U, 9U, 17U, 100U, 700U}) {
    for (const double size : {0.05, 0.5, 3.0}) {
      for (const double grid : {0.0, 0.25, 5.0}) {
        const std::vector<Aabb> boxes = randomBoxes(count, size, grid, random);
        fill(finder, boxes);
        EXPECT_EQ(pairsOf(finder), byAllPairs(boxes)) << count << ' ' << size << ' ' << grid;
      }
    }
  }
}

TEST(BoxPairs, FindsWhatABoxOverlaps) {
  test::RandomValues random(4);
  const std::vector<Aabb> boxes = randomBoxes(300, 0.7, 0.1, random);
  BoxPairs finder(300);
  fill(finder, boxes);
  for (const Aabb& box : randomBoxes(50, 1.0, 0.1, random)) {
    std::vector<std::uint32_t> found, expected;
    finder.forEachAt(box, [&](std::uint32_t i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      if (overlap(box, boxes[i])) expected.push_back(i);
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(BoxPairs, TakesBoxesThatGrowTenfoldEach) {
  // Nearly all centres are in one corner of what they span: a cut in the middle leaves one on its other side.
  std::vector<Aabb> boxes;
  for (int i = 0; i < 300; ++i)
    boxes.push_back({glm::dvec3(std::pow(10.0, i)), glm::dvec3(1.5 * std::pow(10.0, i))});
  BoxPairs finder(boxes.size());
  fill(finder, boxes);
  EXPECT_EQ(pairsOf(finder), Pairs());
}

TEST(BoxPairs, ForgetsWhatItHeldBefore) {
  BoxPairs finder(4);
  const Aabb box{glm::dvec3(0.0), glm::dvec3(1.0)};
  fill(finder, {box, box, box});
  EXPECT_EQ(pairsOf(finder).size(), 3U);
  fill(finder, {box});
  EXPECT_EQ(pairsOf(finder).size(), 0U);
}

}  // namespace
}  // namespace nearfit::box_pairs_test
