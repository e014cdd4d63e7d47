#include "core/proximity/cull_kernel.h"

#include <cmath>
#include <limits>

namespace nearfit {
namespace {

/// Added to every cosine that two directions are held against: some thirty roundings of single precision.
constexpr float kCosinePadding = 2e-6F;

/// Added to the radii as a fraction of the distance between centres: rounding of the distance itself.
constexpr float kLengthPadding = 4e-6F;

}  // namespace

SinglePose::SinglePose(const RigidTransform& pose) noexcept {
  const glm::dmat3 m = glm::mat3_cast(pose.rotation);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      r[row][column] = static_cast<float>(m[column][row]);
    t[row] = static_cast<float>(pose.translation[row]);
  }
}

NormalConeTree::Bound SinglePose::apply(const NormalConeTree::Bound& b) const noexcept {
  NormalConeTree::Bound out = b;
  out.x = r[0][0] * b.x + r[0][1] * b.y + r[0][2] * b.z + t[0];
  out.y = r[1][0] * b.x + r[1][1] * b.y + r[1][2] * b.z + t[1];
  out.z = r[2][0] * b.x + r[2][1] * b.y + r[2][2] * b.z + t[2];
  out.axisX = r[0][0] * b.axisX + r[0][1] * b.axisY + r[0][2] * b.axisZ;
  out.axisY = r[1][0] * b.axisX + r[1][1] * b.axisY + r[1][2] * b.axisZ;
  out.axisZ = r[2][0] * b.axisX + r[2][1] * b.axisY + r[2][2] * b.axisZ;
  return out;
}

std::uint32_t survivingChildren(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                                float cutoff, float padding) noexcept {
  std::int32_t alive[NormalConeTree::kWidth];
  // Branch-free, so that the compiler makes vectors of it.
  for (std::size_t i = 0; i < NormalConeTree::kWidth; ++i) {
    const float dx = other.x - node.x[i], dy = other.y - node.y[i], dz = other.z - node.z[i];
    const float squared = dx * dx + dy * dy + dz * dz;
    const float length = std::sqrt(squared);
    const float radii = node.radius[i] + other.radius + padding + kLengthPadding * length;
    const float reach = radii + cutoff;

    // Cones: angle(axis, -otherAxis) <= sum of half-angles; beyond pi any pair will do.
    const float facing =
        -(node.axisX[i] * other.axisX + node.axisY[i] * other.axisY + node.axisZ[i] * other.axisZ);
    const float cosSum = node.cosAngle[i] * other.cosAngle - node.sinAngle[i] * other.sinAngle;
    const float sinSum = node.sinAngle[i] * other.cosAngle + node.cosAngle[i] * other.sinAngle;

    // Directions from the one sphere to the other differ from D by at most delta.
    const float inverse = 1.0F / (length + std::numeric_limits<float>::min());
    const float sine = radii * inverse;
    const float sinDelta = sine < 1.0F ? sine : 1.0F;
    const float cosDelta = std::sqrt(1.0F - sinDelta * sinDelta);
    const float along = (node.axisX[i] * dx + node.axisY[i] * dy + node.axisZ[i] * dz) * inverse;
    const float against = -(other.axisX * dx + other.axisY * dy + other.axisZ * dz) * inverse;
    const float cosA = node.cosAngle[i] * cosDelta - node.sinAngle[i] * sinDelta;
    const float sinA = node.sinAngle[i] * cosDelta + node.cosAngle[i] * sinDelta;
    const float cosB = other.cosAngle * cosDelta - other.sinAngle * sinDelta;
    const float sinB = other.sinAngle * cosDelta + other.cosAngle * sinDelta;

    const bool isNear = length <= reach;
    const bool canFace = (sinSum <= 0.0F) | (facing >= cosSum - kCosinePadding);
    const bool overlaps = length <= radii;
    const bool aAllows = (sinA <= 0.0F) | (along >= cosA - kCosinePadding);
    const bool bAllows = (sinB <= 0.0F) | (against >= cosB - kCosinePadding);
    alive[i] = isNear & canFace & (overlaps | (aAllows & bAllows));
  }
  std::uint32_t mask = 0;
  for (std::size_t i = 0; i < node.childCount; ++i)
    mask |= static_cast<std::uint32_t>(alive[i]) << i;
  return mask;
}

}  // namespace nearfit
