#include "tests/exact/box_index.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

namespace nearfit::bench::box_index_test {
namespace {

using test::Box;
using test::BoxIndex;

TEST(BoxIndex, FindsTheBoxesThatMeetAnotherInOrder) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> at(-1.0, 1.0), wide(0.0, 0.2);
  // Half of them on a grid, so that many share faces, corners and centres.
  const auto boxAt = [&](bool isOnGrid) {
    const auto place = [&](double x) { return isOnGrid ? std::round(4.0 * x) / 4.0 : x; };
    Box box;
    box.lower = {place(at(random)), place(at(random)), place(at(random))};
    box.upper = box.lower + (isOnGrid ? glm::dvec3(0.25) : glm::dvec3(wide(random), 0.0, wide(random)));
    return box;
  };
  for (const std::size_t count : {0U, 1U, 9U, 1000U}) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i)
      boxes.push_back(boxAt(i % 2 == 0));
    const BoxIndex index(boxes);
    std::vector<std::uint32_t> found;
    for (int trial = 0; trial < 200; ++trial) {
      const Box other = boxAt(trial % 2 == 0);
      std::vector<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (boxes[i].meets(other)) expected.push_back(i);
      }
      index.findMeeting(other, found);
      EXPECT_EQ(found, expected);
    }
  }
}

}  // namespace
}  // namespace nearfit::bench::box_index_test
