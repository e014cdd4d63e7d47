#pragma once

#include <array>
#include <cstdint>

#include "core/proximity/cull_kernel.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// A segment in a tree's frame, in single precision, for bounds only.
struct SegmentBound {
  std::array<float, 3> middle, half;  ///< Ends are middle - half and middle + half [m].
  float padding;                      ///< What rounding may move it by, and how far around it counts [m].
};

/// Which children of a node may hold something that the segment meets: bit per lane. Never leaves out a box
/// that comes within the padding of the segment. Real-time safe.
using SegmentKernel = std::uint32_t (*)(const NormalConeTree::Node& node,
                                        const SegmentBound& segment) noexcept;

/// The kernel for a level that the machine has.
SegmentKernel segmentKernel(SimdLevel level) noexcept;

}  // namespace nearfit
