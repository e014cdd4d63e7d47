#pragma once

#include <cstddef>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// How many of a mesh's features can carry a minimum at all (the others are not in the hierarchy).
struct FeatureCounts {
  std::size_t vertices = 0, edges = 0, faces = 0;
  std::size_t total() const noexcept { return vertices + edges + faces; }
};

/// Spatialized normal cone hierarchy over the features of one mesh that can carry a minimum.
/// Built once for a mesh; immutable, so that any number of threads and parts share it.
class NormalConeTree {
 public:
  explicit NormalConeTree(const TriangleMesh& mesh);

  FeatureCounts keptFeatures() const noexcept { return kept_; }
  FeatureCounts allFeatures() const noexcept { return all_; }
  std::size_t byteSize() const noexcept;

 private:
  FeatureCounts kept_, all_;
};

}  // namespace nearfit
