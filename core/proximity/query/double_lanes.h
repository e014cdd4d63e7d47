#pragma once

#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/query/box_cull.h"
#include "core/proximity/query/lane_vectors.h"

// Eight doubles at a time, as the scalar code computes them: the arithmetic of glm in the order of glm, so that results
// are the same to the last bit if contraction is off. Everything is forced inline, like in box_cull.h.

namespace nearfit::simd {

using Doubles8 = double __attribute__((vector_size(64)));
using Mask8 = std::int64_t __attribute__((vector_size(64)));
using DoubleVectors8 = Triple<Doubles8>;
static_assert(sizeof(Doubles8) == sizeof(LaneNumbers));

NEARFIT_INLINE void store(const Doubles8& from, LaneNumbers& to) {
  __builtin_memcpy(&to, &from, sizeof from);
}
NEARFIT_INLINE void store(const DoubleVectors8& from, LaneVectors& to) {
  store(from.x, to[0]);
  store(from.y, to[1]);
  store(from.z, to[2]);
}

NEARFIT_INLINE DoubleVectors8 spread(const glm::dvec3& v) {
  return {Doubles8{} + v.x, Doubles8{} + v.y, Doubles8{} + v.z};
}
NEARFIT_INLINE DoubleVectors8 plus(const DoubleVectors8& a, const DoubleVectors8& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
NEARFIT_INLINE DoubleVectors8 minus(const DoubleVectors8& a, const DoubleVectors8& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
NEARFIT_INLINE DoubleVectors8 times(const DoubleVectors8& a, const Doubles8& s) {
  return {a.x * s, a.y * s, a.z * s};
}
NEARFIT_INLINE DoubleVectors8 over(const DoubleVectors8& a, const Doubles8& s) {
  return {a.x / s, a.y / s, a.z / s};
}
/// The vectors of `a` in the lanes of the mask, those of `b` in the others.
NEARFIT_INLINE DoubleVectors8 chosen(const Mask8& mask, const DoubleVectors8& a, const DoubleVectors8& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
/// Within 0 and 1, as std::clamp does it.
NEARFIT_INLINE Lanes<Doubles8> asShare(const Doubles8& share) {
  const Doubles8 zero{}, one = Doubles8{} + 1.0;
  return {share < zero ? zero : share > one ? one : share};
}
/// Goes through memory, as there is no operator for it.
NEARFIT_INLINE Lanes<Doubles8> root(const Doubles8& squares) {
  double numbers[kPairLanes];
  __builtin_memcpy(numbers, &squares, sizeof numbers);
  for (double& number : numbers)
    number = __builtin_sqrt(number);
  Lanes<Doubles8> out;
  __builtin_memcpy(&out.value, numbers, sizeof numbers);
  return out;
}
NEARFIT_INLINE Lanes<Doubles8> lengthOf(const DoubleVectors8& v) {
  return root(dot(v, v));
}

/// Rotates as glm does by a quaternion.
NEARFIT_INLINE DoubleVectors8 turned(const RigidTransform& pose, const DoubleVectors8& v) {
  const glm::dquat& q = pose.rotation;
  const DoubleVectors8 axis = spread(glm::dvec3(q.x, q.y, q.z));
  const DoubleVectors8 once = cross(axis, v), twice = cross(axis, once);
  return plus(v, times(plus(times(once, Doubles8{} + q.w), twice), Doubles8{} + 2.0));
}
/// Rotates as glm does by a matrix.
NEARFIT_INLINE DoubleVectors8 turned(const glm::dmat3& turn, const DoubleVectors8& v) {
  return {turn[0].x * v.x + turn[1].x * v.y + turn[2].x * v.z,
          turn[0].y * v.x + turn[1].y * v.y + turn[2].y * v.z,
          turn[0].z * v.x + turn[1].z * v.y + turn[2].z * v.z};
}

constexpr Mask8 kLaneBits{1, 2, 4, 8, 16, 32, 64, 128};
/// The lanes that have their bit.
NEARFIT_INLINE Mask8 lanesOfBits(std::uint8_t bits) {
  return ((Mask8{} + static_cast<std::int64_t>(bits)) & kLaneBits) != 0;
}
/// A bit for each lane in which a comparison holds.
NEARFIT_INLINE std::uint8_t bitsOf(const Mask8& holds) {
  using HalfBits = std::int64_t __attribute__((vector_size(32)));
  const Mask8 bits = holds & kLaneBits;
  const HalfBits halves =
      __builtin_shufflevector(bits, bits, 0, 1, 2, 3) | __builtin_shufflevector(bits, bits, 4, 5, 6, 7);
  return static_cast<std::uint8_t>(halves[0] | halves[1] | halves[2] | halves[3]);
}

}  // namespace nearfit::simd
