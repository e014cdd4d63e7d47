#pragma once

#include <array>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "device/plugin/nearfit_device.h"

namespace nearfit::plugin {

/// Turns what a maker's library says in its axes into Nearfit's: x to the right, y away from the user, z up.
class DeviceFrame {
 public:
  /// @param nearfitFromMaker  A rotation: its columns are the maker's axes, in Nearfit's.
  explicit DeviceFrame(const glm::dmat3& nearfitFromMaker) noexcept : rotation_(nearfitFromMaker) {}

  glm::dvec3 fromMaker(const glm::dvec3& vector) const noexcept { return rotation_ * vector; }
  glm::dvec3 toMaker(const std::array<double, 3>& vector) const noexcept {
    return glm::transpose(rotation_) * glm::dvec3(vector[0], vector[1], vector[2]);
  }
  /// Orientation of a handle whose own axes are turned alike, so that it rests at the identity in both.
  glm::dquat fromMaker(const glm::dmat3& deviceFromHandle) const noexcept {
    return glm::normalize(glm::quat_cast(rotation_ * deviceFromHandle * glm::transpose(rotation_)));
  }

 private:
  glm::dmat3 rotation_;
};

inline void put(const glm::dvec3& from, double (&to)[3]) noexcept {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}
inline void put(const glm::dquat& from, double (&to)[4]) noexcept {
  to[0] = from.w;
  to[1] = from.x;
  to[2] = from.y;
  to[3] = from.z;
}

/// Damping that a device of this stiffness must have: its maker lets it render walls so stiff at that rate, which
/// Colgate's bound (virtual_coupling.h) allows from b = K T / 2 on. An estimate on the low side, as is safe.
/// @param stiffness  [N/m], or [N m/rad]; the result is [N s/m], or [N m s/rad].
/// @param rate       [Hz]; > 0.
inline double dampingFromStiffness(double stiffness, double rate) noexcept {
  return 0.5 * stiffness / rate;
}

}  // namespace nearfit::plugin
