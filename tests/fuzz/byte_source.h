#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit::fuzz {

/// Values out of a fuzzer's bytes, from the front on; zeros when there are no more.
class ByteSource {
 public:
  ByteSource(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}

  bool isEmpty() const { return bytes_.empty(); }
  std::span<const std::uint8_t> rest() const { return bytes_; }

  template <typename T>
  T raw() {
    std::array<std::uint8_t, sizeof(T)> bytes{};
    const std::size_t count = std::min(bytes.size(), bytes_.size());
    std::copy_n(bytes_.begin(), count, bytes.begin());
    bytes_ = bytes_.subspan(count);
    return std::bit_cast<T>(bytes);
  }
  std::uint8_t byte() { return raw<std::uint8_t>(); }
  /// 0 to limit - 1.
  std::size_t below(std::size_t limit) { return byte() % limit; }
  bool flag() { return (byte() & 1U) != 0; }

  /// Any double, with those that tests forget oftener than chance has them.
  double number() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr std::array kSpecial{0.0,    -0.0,      1.0,        -1.0,
                                  0.5,    1e-12,     1e-9,       1e-6,
                                  1e-3,   1e3,       1e6,        1e9,
                                  1e-150, 1e-300,    1e150,      1e300,
                                  5e-324, kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()};
    const std::uint8_t kind = byte();
    if (kind < 128) return (kind - 64) / 16.0;
    if (kind < 160) return raw<std::int16_t>() / 4096.0;
    if (kind < 200) return kSpecial[kind % kSpecial.size()];
    if (kind < 230) return static_cast<double>(raw<float>());
    return raw<double>();
  }
  glm::dvec3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  /// Any numbers at all.
  RigidTransform anyPose() {
    const glm::dvec3 t = vector(), v = vector();
    return {glm::dquat(number(), v.x, v.y, v.z), t};
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace nearfit::fuzz
