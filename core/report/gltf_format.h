#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

/// Numbers of glTF 2.0 and its binary form, and colours as it wants them.
namespace nearfit::gltf {

constexpr std::uint32_t kGlbMagic = 0x46546C67, kGlbVersion = 2, kJsonChunk = 0x4E4F534A,
                        kBinaryChunk = 0x004E4942;
constexpr int kFloatType = 5126, kUint16Type = 5123, kUint32Type = 5125, kArrayTarget = 34962,
              kIndexTarget = 34963, kTrianglesMode = 4;

/// Linear value of an sRGB channel. Source: IEC 61966-2-1.
inline double linearOf(float srgb) {
  const double c = std::clamp(static_cast<double>(srgb), 0.0, 1.0);
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

}  // namespace nearfit::gltf
