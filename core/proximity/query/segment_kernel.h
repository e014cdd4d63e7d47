#pragma once

#include <array>
#include <cstdint>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/cull_kernel.h"

namespace nearfit {

/// Segment in a tree's frame, in single precision, for bounds only.
struct SegmentBound {
  std::array<float, 3> middle, half;  ///< Ends are middle - half and middle + half [m].
  float padding;                      ///< Rounding of the segment, plus the clearance that counts [m].
};

/// Returns which children of a node may hold something that the segment meets, one bit per lane. Never misses
/// a box within the padding of the segment. Real-time safe.
using SegmentKernel = std::uint32_t (*)(const NormalConeTree::Node& node,
                                        const SegmentBound& segment) noexcept;

/// Returns the kernel for an instruction set that the machine has.
SegmentKernel segmentKernel(SimdLevel level) noexcept;

}  // namespace nearfit
