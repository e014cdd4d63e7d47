#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

#include "core/haptics/mass_metric.h"
#include "core/proximity/query/cull_kernel.h"

namespace nearfit {

/// A motion of the part in its mass metric [m]: translation of the centre of mass, then rotation about each
/// principal axis times the radius of gyration about it. Half its squared length is the kinetic energy of a
/// unit mass that moves so in unit time.
using StepVector = std::array<double, 6>;

/// Row of a pair of points: its dot product with a step is the change of their distance, to first order.
/// @param direction           From scene to part, in the world; unit.
/// @param arm                 From the centre of mass to the part's point, in the world [m].
/// @param principalFromWorld  Rotates the world into the part's principal axes.
/// Real-time safe.
inline StepVector stepRow(const glm::dvec3& direction, const glm::dvec3& arm,
                          const glm::dquat& principalFromWorld, const MassMetric& metric) noexcept {
  const glm::dvec3 turn = principalFromWorld * glm::cross(arm, direction) / metric.gyration;
  return {direction.x, direction.y, direction.z, turn.x, turn.y, turn.z};
}

/// Near pairs of points, linearised: after the step y pair i is a_i . y + d_i apart, to first order.
///
/// Stored in blocks of columns, so that the scan over all rows vectorises.
class StepRows {
 public:
  static constexpr std::size_t kDefaultCapacity = 512;

  /// Numbers beyond this are refused, so that no product of two overflows.
  static constexpr double kLargest = 1e12;

  /// @param capacity  Max number of rows. Allocates; nothing after it does.
  /// @param level     An instruction set that the machine has.
  explicit StepRows(std::size_t capacity = kDefaultCapacity, SimdLevel level = defaultSimdLevel());

  void clear() noexcept;

  /// Adds the row of a pair.
  /// @param a  stepRow() of the pair.
  /// @param d  Its distance [m].
  /// @return False, with nothing added, if there is no room or a number is not finite or beyond `kLargest`.
  ///         The part must then not take the program's step, which does not know of this pair.
  /// Real-time safe.
  bool add(const StepVector& a, double d) noexcept;

  std::size_t size() const noexcept { return size_; }
  std::size_t capacity() const noexcept { return capacity_; }

  /// a_i; i < size().
  StepVector row(std::size_t i) const noexcept;
  /// d_i [m]; i < size().
  double distance(std::size_t i) const noexcept;

  /// Max |a_i|, at least 1.
  double largestNorm() const noexcept { return std::sqrt(largestSquare_); }

  /// The row with the min clearance.
  struct Least {
    double clearance;  ///< [m]; beyond kLargest without rows.
    std::size_t row;   ///< The first row that has it.
  };

  /// Min of a_i . y + d_i. The same on every machine. Real-time safe; O(rows).
  Least leastClearance(const StepVector& y) const noexcept;

 private:
  static constexpr std::size_t kLanes = 8;
  struct alignas(64) Block {
    std::array<std::array<double, kLanes>, 6> a{};
    std::array<double, kLanes> d{};
  };
  using LeastKernel = Least (*)(const Block* blocks, std::size_t count, const StepVector& y) noexcept;
  struct Kernels;
  static LeastKernel leastKernel(SimdLevel level) noexcept;

  std::vector<Block> blocks_;
  std::size_t capacity_, size_ = 0;
  double largestSquare_ = 1.0;
  LeastKernel leastKernel_;
};

}  // namespace nearfit
