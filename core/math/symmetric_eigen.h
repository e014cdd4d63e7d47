#pragma once

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// Eigenvalues of a symmetric 3x3 matrix in ascending order, with orthonormal eigenvectors in the same order.
/// The eigenvectors may form a left-handed frame.
struct SymmetricEigen {
  std::array<double, 3> values;
  std::array<glm::dvec3, 3> vectors;
};

/// Eigenvalues and eigenvectors of `matrix`, by Jacobi rotations. Reads only the upper triangle.
SymmetricEigen symmetricEigen(const glm::dmat3& matrix) noexcept;

}  // namespace nearfit
