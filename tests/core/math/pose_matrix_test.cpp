#include "core/math/pose_matrix.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <gtest/gtest.h>

namespace nearfit::pose_matrix_test {
namespace {

using Numbers = std::array<double, 16>;

/// A quarter turn about z and a shift, by rows.
constexpr Numbers kQuarter{0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1};

TEST(PoseMatrix, RowsTurnAndShiftPoints) {
  const auto pose = rigidOfMatrix(kQuarter);
  ASSERT_TRUE(pose);
  const glm::dvec3 moved = pose->applyToPoint({1, 0, 0});
  EXPECT_NEAR(moved.x, 1.0, 1e-15);
  EXPECT_NEAR(moved.y, 3.0, 1e-15);
  EXPECT_NEAR(moved.z, 3.0, 1e-15);
}

TEST(PoseMatrix, AMatrixOfAPoseGivesThePoseBack) {
  for (const glm::dquat& q :
       {glm::dquat(0.5, 0.5, 0.5, 0.5), glm::dquat(0, 1, 0, 0), glm::dquat(0.1, -0.7, 0.3, 0.6)}) {
    const RigidTransform pose = RigidTransform{q, {1, -2, 3}}.normalized();
    const glm::dmat4 matrix = pose.toMatrix();
    Numbers rows{};
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i] = matrix[static_cast<int>(i % 4)][static_cast<int>(i / 4)];
    const auto back = rigidOfMatrix(rows);
    ASSERT_TRUE(back);
    EXPECT_NEAR(std::abs(glm::dot(back->rotation, pose.rotation)), 1.0, 1e-14);
    EXPECT_EQ(back->translation, pose.translation);
  }
}

TEST(PoseMatrix, WhatDoesMoreThanTurnAndShiftIsRefused) {
  const auto changed = [](std::size_t index, double value) {
    Numbers numbers = kQuarter;
    numbers[index] = value;
    return numbers;
  };
  EXPECT_FALSE(rigidOfMatrix(changed(10, -1.0))) << "a mirror";
  EXPECT_FALSE(rigidOfMatrix(changed(10, 1.01))) << "a scale";
  EXPECT_FALSE(rigidOfMatrix(changed(0, 0.1))) << "a shear";
  EXPECT_FALSE(rigidOfMatrix(changed(12, 0.1))) << "a perspective";
  EXPECT_FALSE(rigidOfMatrix(changed(15, 0.0)));
  EXPECT_FALSE(rigidOfMatrix(changed(3, std::numeric_limits<double>::infinity())));
  EXPECT_FALSE(rigidOfMatrix(changed(0, std::nan(""))));
}

}  // namespace
}  // namespace nearfit::pose_matrix_test
