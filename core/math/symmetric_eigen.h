#pragma once

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// Eigenvalues of a symmetric matrix, smallest first, with unit eigenvectors that are square to each other.
struct SymmetricEigen {
  std::array<double, 3> values;
  std::array<glm::dvec3, 3> vectors;
};

/// By Jacobi's rotations; only the upper triangle is read.
SymmetricEigen symmetricEigen(const glm::dmat3& matrix) noexcept;

}  // namespace nearfit
