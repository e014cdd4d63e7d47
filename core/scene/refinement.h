#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/scene/part_geometry.h"
#include "core/scene/scene.h"

namespace nearfit {

/// What to load to give parts another tessellation.
struct Refinement {
  std::vector<MeshSource> sources;  ///< With the content that the parts were read from.
  struct Member {
    PartId part{};
    std::size_t source = 0;  ///< Index.
  };
  std::vector<Member> members;  ///< All instances of the parts' shapes, in scene order.
};

/// Plans to refine parts: all instances of their shapes follow. Throws UsageError if a part is unknown, comes from a
/// mesh file or from a shape that is not of exact surfaces, or checkTessellation() refuses the tessellation.
Refinement refinementOf(const Scene& scene, std::span<const PartId> parts, const Tessellation& tessellation);

/// The same tessellation for a shape scaled by a factor; its chord stays within its limits.
Tessellation scaledTessellation(const Tessellation& tessellation, double factor);

/// True if the part can be refined.
bool isRefinable(const Part& part) noexcept;

}  // namespace nearfit
