#include "core/math/symmetric_eigen.h"

#include <random>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

namespace nearfit::symmetric_eigen_test {
namespace {

TEST(SymmetricEigen, VectorsDiagonaliseRandomMatrices) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    glm::dmat3 m(0.0);
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r <= c; ++r)
        m[c][r] = m[r][c] = normal(random) * (i % 2 == 0 ? 1.0 : 1e-8);
    }
    const SymmetricEigen eigen = symmetricEigen(m);
    const double scale = glm::length(m[0]) + glm::length(m[1]) + glm::length(m[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT(glm::length(m * eigen.vectors[k] - eigen.values[k] * eigen.vectors[k]), 1e-14 * scale);
      EXPECT_NEAR(glm::length(eigen.vectors[k]), 1.0, 1e-14);
      EXPECT_NEAR(glm::dot(eigen.vectors[k], eigen.vectors[(k + 1) % 3]), 0.0, 1e-14);
    }
    EXPECT_LE(eigen.values[0], eigen.values[1]);
    EXPECT_LE(eigen.values[1], eigen.values[2]);
  }
}

TEST(SymmetricEigen, ZeroAndMultiplesOfTheIdentityKeepTheAxes) {
  for (const double value : {0.0, 2.5}) {
    const SymmetricEigen eigen = symmetricEigen(glm::dmat3(value));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(eigen.values[k], value);
      EXPECT_NEAR(glm::length(eigen.vectors[k]), 1.0, 1e-15);
    }
  }
}

}  // namespace
}  // namespace nearfit::symmetric_eigen_test
