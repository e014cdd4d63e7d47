#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <source_location>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

/// What each fuzz target defines: runs one input, returns 0, and does not come back where something is wrong.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace nearfit::fuzz {

/// Ends the program where what must hold does not: a fuzzer or a replay then keeps and names the input.
inline void require(bool holds, const char* what,
                    const std::source_location& where = std::source_location::current()) {
  if (holds) return;
  std::fprintf(stderr, "%s:%u: does not hold: %s\n", where.file_name(), static_cast<unsigned>(where.line()),
               what);
  std::abort();
}

inline bool isFinite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// What is read from an input is right, as `read` checks, or refused with an error that says what is wrong.
/// @tparam Refusal  The errors that may come.
template <typename Refusal, typename Read>
void requireReadOrRefused(Read&& read) {
  try {
    read();
  } catch (const Refusal& error) {
    require(!error.problem().empty(), "an error says what is wrong");
  }
}

/// Whether a pose is one that may be shown: finite, its quaternion unit to some roundings.
inline bool isPose(const RigidTransform& pose) {
  constexpr double kUnit = 1e-12;
  return pose.isFinite() && std::abs(glm::length(pose.rotation) - 1.0) <= kUnit;
}

}  // namespace nearfit::fuzz
