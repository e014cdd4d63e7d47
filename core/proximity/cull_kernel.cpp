#include "core/proximity/cull_kernel.h"

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "core/proximity/cull_kernel_variants.h"

namespace nearfit {

SinglePose::SinglePose(const RigidTransform& pose) noexcept {
  const glm::dmat3 m = glm::mat3_cast(pose.rotation);
  for (std::size_t row = 0; row < 3; ++row) {
    const auto i = static_cast<int>(row);
    for (std::size_t column = 0; column < 3; ++column) {
      columns[column][row] = static_cast<float>(m[static_cast<int>(column)][i]);
    }
    columns[3][row] = static_cast<float>(pose.translation[i]);
  }
  for (auto& column : columns)
    column[3] = 0.0F;
}

NormalConeTree::Bound SinglePose::apply(const NormalConeTree::Bound& b) const noexcept {
  // Four at a time: the compiler makes one vector of each line.
  std::array<float, 4> centre, axis;
  for (std::size_t i = 0; i < 4; ++i) {
    centre[i] = columns[0][i] * b.x + columns[1][i] * b.y + columns[2][i] * b.z + columns[3][i];
    axis[i] = columns[0][i] * b.axisX + columns[1][i] * b.axisY + columns[2][i] * b.axisZ;
  }
  return {centre[0], centre[1], centre[2], b.radius, axis[0], axis[1], axis[2], b.cosAngle, b.sinAngle};
}

std::uint32_t detail::cullPortable(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                                   const CullLimits& limits) noexcept {
  std::uint32_t alive = 0;
  for (std::uint32_t i = 0; i < node.childCount; ++i) {
    const float dx = other.x - node.x[i], dy = other.y - node.y[i], dz = other.z - node.z[i];
    const float length = std::sqrt(dx * dx + dy * dy + dz * dz);
    const float radii = node.radius[i] + other.radius + limits.padding + kLengthPadding * length;
    if (length > radii + limits.cutoff) continue;

    // Cones: angle(axis, -otherAxis) <= sum of half-angles; beyond pi any pair will do.
    const float facing =
        -(node.axisX[i] * other.axisX + node.axisY[i] * other.axisY + node.axisZ[i] * other.axisZ);
    const float cosSum = node.cosAngle[i] * other.cosAngle - node.sinAngle[i] * other.sinAngle;
    const float sinSum = node.sinAngle[i] * other.cosAngle + node.cosAngle[i] * other.sinAngle;
    if (sinSum > 0.0F && facing < cosSum - kCosinePadding) continue;

    // Directions from the one sphere to the other differ from D by at most delta.
    if (length > radii) {
      const float inverse = 1.0F / length, sinDelta = radii * inverse;
      const float cosDelta = std::sqrt(1.0F - sinDelta * sinDelta);
      const float along = (node.axisX[i] * dx + node.axisY[i] * dy + node.axisZ[i] * dz) * inverse;
      const float against = -(other.axisX * dx + other.axisY * dy + other.axisZ * dz) * inverse;
      const float cosA = node.cosAngle[i] * cosDelta - node.sinAngle[i] * sinDelta;
      const float sinA = node.sinAngle[i] * cosDelta + node.cosAngle[i] * sinDelta;
      const float cosB = other.cosAngle * cosDelta - other.sinAngle * sinDelta;
      const float sinB = other.sinAngle * cosDelta + other.cosAngle * sinDelta;
      if (sinA > 0.0F && along < cosA - kCosinePadding) continue;
      if (sinB > 0.0F && against < cosB - kCosinePadding) continue;
    }
    alive |= 1U << i;
  }
  return alive;
}

std::span<const SimdLevel> availableSimdLevels() noexcept {
  static constexpr std::array<SimdLevel, 3> kLevels{SimdLevel::Portable, SimdLevel::Avx2, SimdLevel::Avx512};
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("fma")) {
    return kLevels;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return std::span(kLevels).first(2);
#endif
  return std::span(kLevels).first(1);
}

CullKernel cullKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return detail::cullAvx512;
  if (level == SimdLevel::Avx2) return detail::cullAvx2;
#endif
  static_cast<void>(level);
  return detail::cullPortable;
}

SimdLevel defaultSimdLevel() noexcept {
  static const SimdLevel chosen = [] {
    const std::span<const SimdLevel> available = availableSimdLevels();
    const char* wanted = std::getenv("NEARFIT_SIMD");
    const std::string_view name = wanted == nullptr ? "" : wanted;
    for (const SimdLevel level : available) {
      if ((level == SimdLevel::Portable && name == "portable") ||
          (level == SimdLevel::Avx2 && name == "avx2")) {
        return level;
      }
    }
    return available.back();
  }();
  return chosen;
}

}  // namespace nearfit
