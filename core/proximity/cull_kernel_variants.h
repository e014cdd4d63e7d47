#pragma once

#include "core/proximity/cull_kernel.h"

/// The variants behind cullKernel(): one algorithm, lane by lane in portable C++, eight at once on x86-64.
namespace nearfit::detail {

/// Added to every cosine that two directions are held against: some thirty roundings of single precision.
constexpr float kCosinePadding = 2e-6F;

/// Added to the radii as a fraction of the distance between centres: rounding of the distance itself.
constexpr float kLengthPadding = 4e-6F;

/// Keeps quotients by the distance finite where centres coincide; the spheres overlap there anyhow.
constexpr float kLeastLength = 1e-30F;

std::uint32_t cullPortable(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                           const CullLimits& limits) noexcept;
#if defined(__x86_64__)
std::uint32_t cullAvx2(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                       const CullLimits& limits) noexcept;
std::uint32_t cullAvx512(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                         const CullLimits& limits) noexcept;
#endif

}  // namespace nearfit::detail
