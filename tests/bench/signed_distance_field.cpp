#include "tests/bench/signed_distance_field.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/parallel/parallel_for.h"
#include "core/proximity/overlap/containment.h"
#include "tests/bench/mesh_distance.h"

namespace nearfit::bench {

SignedDistanceField::SignedDistanceField(const NormalConeTree& tree, std::size_t cells, double reach) {
  const TriangleMesh& mesh = tree.mesh();
  const glm::dvec3 size = mesh.bounds().upper - mesh.bounds().lower + 2.0 * reach;
  cell_ = std::max({size.x, size.y, size.z}) / static_cast<double>(cells);
  origin_ = mesh.bounds().lower - reach;
  for (std::size_t k = 0; k < 3; ++k)
    count_[k] = 1 + static_cast<std::size_t>(std::ceil(size[static_cast<glm::length_t>(k)] / cell_ - 1e-9));
  values_.resize(count_[0] * count_[1] * count_[2]);

  const MeshDistance distance(mesh);
  const PlacedMesh placed(tree, nullptr);
  const MeshComponents pieces = piecesOf(mesh);
  const PlacedSolid solid(placed, pieces);
  parallelFor(count_[2], [&](std::size_t z) {
    for (std::size_t y = 0; y < count_[1]; ++y) {
      double before = 0.0;
      bool isInside = false;
      std::uint32_t nearest = 0;
      for (std::size_t x = 0; x < count_[0]; ++x) {
        const glm::dvec3 point = corner(x, y, z);
        const double here = distance.ofNext(point, nearest);
        // Between two corners that are farther from the surface than from each other, it does not pass.
        if (x == 0 || here + before <= cell_) isInside = here > 0.0 && solid.contains(point);
        before = here;
        values_[indexOf(x, y, z)] = static_cast<float>(isInside ? -here : here);
      }
    }
  });
}

glm::dvec3 SignedDistanceField::corner(std::size_t x, std::size_t y, std::size_t z) const noexcept {
  return origin_ + cell_ * glm::dvec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
}

double SignedDistanceField::distanceOfGrid(const glm::dvec3& point) const noexcept {
  const glm::dvec3 end = corner(count_[0] - 1, count_[1] - 1, count_[2] - 1);
  return glm::length(glm::max(glm::max(origin_ - point, point - end), glm::dvec3(0.0)));
}

std::optional<SignedDistanceField::Sample> SignedDistanceField::at(const glm::dvec3& point) const noexcept {
  const glm::dvec3 place = (point - origin_) / cell_;
  std::array<std::size_t, 3> low{};
  std::array<double, 3> t{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double along = place[static_cast<glm::length_t>(k)];
    if (!(along >= 0.0) || along >= static_cast<double>(count_[k] - 1)) return std::nullopt;
    low[k] = static_cast<std::size_t>(along);
    t[k] = along - static_cast<double>(low[k]);
  }
  const float* const first = &values_[indexOf(low[0], low[1], low[2])];
  const std::size_t row = count_[0], layer = count_[0] * count_[1];
  const auto value = [&](std::size_t offset) { return static_cast<double>(first[offset]); };
  // Along x on the four sides of the cell, then along y, then along z.
  const auto mix = [](double a, double b, double share) { return a + share * (b - a); };
  const double a00 = mix(value(0), value(1), t[0]), a10 = mix(value(row), value(row + 1), t[0]);
  const double a01 = mix(value(layer), value(layer + 1), t[0]),
               a11 = mix(value(layer + row), value(layer + row + 1), t[0]);
  const double d00 = value(1) - value(0), d10 = value(row + 1) - value(row),
               d01 = value(layer + 1) - value(layer), d11 = value(layer + row + 1) - value(layer + row);
  const double b0 = mix(a00, a10, t[1]), b1 = mix(a01, a11, t[1]);
  const glm::dvec3 gradient(mix(mix(d00, d10, t[1]), mix(d01, d11, t[1]), t[2]),
                            mix(a10 - a00, a11 - a01, t[2]), b1 - b0);
  return Sample{mix(b0, b1, t[2]), gradient / cell_};
}

}  // namespace nearfit::bench
