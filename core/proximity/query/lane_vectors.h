#pragma once

#include <array>
#include <cstddef>

#include <glm/vec3.hpp>

namespace nearfit {

/// Lanes of a block of pairs.
constexpr std::size_t kPairLanes = 8;

/// A number, and three coordinates of a vector, for each lane of a block.
using LaneNumbers = std::array<double, kPairLanes>;
using LaneVectors = std::array<LaneNumbers, 3>;

inline glm::dvec3 vectorIn(const LaneVectors& vectors, std::size_t lane) noexcept {
  return {vectors[0][lane], vectors[1][lane], vectors[2][lane]};
}
inline void setVector(LaneVectors& vectors, std::size_t lane, const glm::dvec3& to) noexcept {
  vectors[0][lane] = to.x;
  vectors[1][lane] = to.y;
  vectors[2][lane] = to.z;
}

}  // namespace nearfit
