#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/proximity/hierarchy/feature_geometry.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {

/// Extents of features in position [m] and in direction of minima, along the axes n, u, v of a set. `most`
/// holds the negated min and the max along each axis, of position and then of direction; the last four
/// entries are unused. The extents of several features are the max of each entry.
struct alignas(64) Extents {
  static constexpr std::size_t kCount = 12;
  std::array<float, 16> most;

  float middle(std::size_t axis) const noexcept { return 0.5F * (most[2 * axis + 1] - most[2 * axis]); }
  float half(std::size_t axis) const noexcept { return 0.5F * (most[2 * axis + 1] + most[2 * axis]); }
  void add(const Extents& other) noexcept {
    for (std::size_t i = 0; i < most.size(); ++i)
      most[i] = most[i] < other.most[i] ? other.most[i] : most[i];
  }
  /// Extents of no feature, neutral in add().
  static Extents none() noexcept;
};

/// Bounds sets of features by boxes and limits of direction, each on axes of its own. Reuses its work space;
/// one per thread.
class FeatureSetBounds {
 public:
  /// @param geometry  Kept by reference.
  /// @param size      The mesh's diagonal [m].
  FeatureSetBounds(const FeatureGeometry& geometry, double size) : geometry_(geometry), size_(size) {}

  /// Loads the features from which later sets are formed; these name them by their index in `features`.
  void load(std::span<const std::uint32_t> features);

  /// Returns a box and limits of direction that hold all features of the non-empty set `part`.
  NormalConeTree::Bound bound(std::span<const std::uint32_t> part);

  /// Extents of each loaded feature, along the axes of the last bounded set that holds it.
  std::span<const Extents> extents() const noexcept { return extents_; }

  /// Returns a box without limits of direction, for very many features. Loads a sample of them.
  NormalConeTree::Bound boundOfMany(std::span<const std::uint32_t> features);

 private:
  using Frame = std::array<glm::dvec3, 3>;  ///< n, u, v.

  /// Vectors by coordinate; close() pads them to a multiple of eight.
  struct Vectors {
    std::array<std::vector<float>, 3> c;
    std::size_t count = 0;
    void clear() noexcept;
    void add(const glm::dvec3& v);
    void add(const Vectors& from, std::size_t first, std::size_t end);
    void close();
    glm::dvec3 at(std::size_t i) const noexcept { return {c[0][i], c[1][i], c[2][i]}; }
  };
  struct Loaded {
    std::uint32_t feature, firstPoint, firstRay, endPoint, endRay;
    float stretch;
  };
  /// Corners and rays of a set of features.
  struct Cloud {
    Vectors points, rays;
  };
  struct Range {
    float low, high;
  };

  void gather(std::span<const std::uint32_t> part);
  static Range range(const Vectors& vectors, const glm::dvec3& along) noexcept;
  Frame axes() const;
  Frame axesOfOne(const Loaded& f) const;
  void centreDirections(Frame& frame) const noexcept;
  double cost(const Frame& frame) const noexcept;
  Frame best(const Frame& start) const noexcept;
  Extents extentsOf(const Loaded& feature, const Frame& frame) const noexcept;
  NormalConeTree::Bound boundOf(const Extents& all, const Frame& frame) const noexcept;

  const FeatureGeometry& geometry_;
  double size_;
  Cloud loaded_, part_;
  std::vector<Loaded> features_;
  std::vector<Extents> extents_;
  FeatureGeometry::Rays raysOfFeature_;
};

}  // namespace nearfit
