#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "core/proximity/lmd.h"

namespace nearfit::bench {

/// FNV-1a, by words in place of bytes.
class Digest {
 public:
  void add(std::uint64_t word) noexcept {
    value_ = (value_ ^ word) * 0x100000001b3U;
    value_ ^= value_ >> 32;  // Else the highest bits of a word would reach nothing but themselves.
  }
  void add(double number) noexcept { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const glm::dvec3& v) noexcept {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  void add(std::span<const Lmd> lmds) noexcept {
    add(std::uint64_t{lmds.size()});
    for (const Lmd& lmd : lmds)
      add(lmd);
  }
  void add(const RegionExtent& extent) noexcept {
    add(extent.axis);
    for (const double length :
         {extent.measure, extent.halfLength, extent.halfWidth, extent.inside.x, extent.inside.y})
      add(length);
    add(std::uint64_t{extent.dimension});
  }
  void add(const Lmd& lmd) noexcept {
    add(lmd.scenePoint);
    add(lmd.partPoint);
    add(lmd.direction);
    add(lmd.distance);
    add(std::uint64_t{lmd.sceneIndex} << 32 | lmd.partIndex);
    add(static_cast<std::uint64_t>(lmd.sceneFeature) << 8 | static_cast<std::uint64_t>(lmd.partFeature) << 4 |
        (lmd.isMarginal ? 4U : 0U) | (lmd.isRegion ? 2U : 0U) | (lmd.isBlocked ? 1U : 0U));
    if (lmd.isRegion) add(lmd.extent);
  }
  std::uint64_t value() const noexcept { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace nearfit::bench
