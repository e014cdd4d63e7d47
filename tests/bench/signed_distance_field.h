#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit::bench {

/// Signed distance to a closed mesh on a grid of cubes, interpolated between their corners: what voxmap and
/// point-shell methods hold instead of the mesh (McNeely, Puterbaugh & Troy 1999; Barbic & James 2008).
/// Distances at the corners are exact to single precision.
class SignedDistanceField {
 public:
  /// @param tree   Of a closed mesh; not kept.
  /// @param cells  Along the grid's longest side.   @param reach  The grid goes so far beyond the mesh [m].
  SignedDistanceField(const NormalConeTree& tree, std::size_t cells, double reach);

  /// Distance and its gradient within a cell, which is not of unit length everywhere.
  struct Sample {
    double distance;
    glm::dvec3 gradient;
  };
  /// None outside of the grid, where everything is beyond the reach.
  std::optional<Sample> at(const glm::dvec3& point) const noexcept;

  /// How far a point is from the grid; 0 within [m].
  double distanceOfGrid(const glm::dvec3& point) const noexcept;

  double cell() const noexcept { return cell_; }  ///< Side of a cube [m].
  std::size_t byteSize() const noexcept { return values_.size() * sizeof(float); }

 private:
  std::size_t indexOf(std::size_t x, std::size_t y, std::size_t z) const noexcept {
    return (z * count_[1] + y) * count_[0] + x;
  }
  glm::dvec3 corner(std::size_t x, std::size_t y, std::size_t z) const noexcept;

  glm::dvec3 origin_;
  double cell_;
  std::array<std::size_t, 3> count_;  ///< Corners along each axis.
  std::vector<float> values_;
};

}  // namespace nearfit::bench
