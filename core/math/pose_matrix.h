#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit {

/// Tolerance on a matrix of a pose: on the lengths of its axes, the cosines between them, and its last row. Covers numbers
/// that were printed with four digits.
constexpr double kMatrixSlack = 1e-3;

/// The pose that a homogeneous 4x4 matrix for column vectors stands for, with a unit quaternion; std::nullopt if a number is
/// not finite, or the matrix does more than turn and shift.
/// @param rows  Its numbers, row by row.
inline std::optional<RigidTransform> rigidOfMatrix(std::span<const double, 16> rows) noexcept {
  for (const double number : rows) {
    if (!std::isfinite(number)) return std::nullopt;
  }
  glm::dmat3 turn;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      turn[column][row] = rows[static_cast<std::size_t>(4 * row + column)];
  }
  const glm::dmat3 off = glm::transpose(turn) * turn - glm::dmat3(1.0);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      if (!(std::abs(off[column][row]) <= kMatrixSlack)) return std::nullopt;
    }
  }
  const bool hasUsualRow = std::abs(rows[12]) <= kMatrixSlack && std::abs(rows[13]) <= kMatrixSlack &&
                           std::abs(rows[14]) <= kMatrixSlack && std::abs(rows[15] - 1.0) <= kMatrixSlack;
  if (!hasUsualRow || !(glm::determinant(turn) > 0.0)) return std::nullopt;
  return RigidTransform{glm::quat_cast(turn), {rows[3], rows[7], rows[11]}}.normalized();
}

}  // namespace nearfit
