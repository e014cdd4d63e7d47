#pragma once

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// Rotation followed by translation. `bFromA` maps coordinates in frame A to coordinates in frame B.
/// The rotation is a unit quaternion (w, x, y, z), the translation is in metres.
struct RigidTransform {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 translation{0.0};

  /// Number by number: q and -q, which turn alike, differ.
  bool operator==(const RigidTransform& other) const noexcept {
    return rotation == other.rotation && translation == other.translation;
  }

  glm::dvec3 applyToPoint(const glm::dvec3& p) const noexcept { return rotation * p + translation; }
  glm::dvec3 applyToVector(const glm::dvec3& v) const noexcept { return rotation * v; }

  /// Inverse, for a unit quaternion.
  RigidTransform inverse() const noexcept {
    const glm::dquat q = glm::conjugate(rotation);
    return {q, -(q * translation)};
  }

  /// The same transform with a unit quaternion; the rotation becomes the identity if the quaternion is zero
  /// or not finite.
  RigidTransform normalized() const noexcept {
    const double length = std::sqrt(glm::dot(rotation, rotation));
    if (!(length > 0.0) || !std::isfinite(length)) return {glm::dquat{1.0, 0.0, 0.0, 0.0}, translation};
    return {rotation / length, translation};
  }

  /// True if rotation and translation are finite; does not check that the quaternion has unit length.
  bool isFinite() const noexcept {
    return std::isfinite(rotation.w + rotation.x + rotation.y + rotation.z) &&
           std::isfinite(translation.x + translation.y + translation.z);
  }

  /// Homogeneous 4x4 matrix, for column vectors.
  glm::dmat4 toMatrix() const noexcept {
    glm::dmat4 m = glm::mat4_cast(rotation);
    m[3] = glm::dvec4(translation, 1.0);
    return m;
  }
};

/// aFromC = aFromB * bFromC
inline RigidTransform operator*(const RigidTransform& a, const RigidTransform& b) noexcept {
  return {a.rotation * b.rotation, a.applyToPoint(b.translation)};
}

}  // namespace nearfit
