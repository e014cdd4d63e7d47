#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/scene/part.h"

namespace nearfit {

/// Identifies a joint within its scene; never reused.
enum class JointId : std::uint32_t {};

/// The way a part is kept.
enum class JointKind : std::uint8_t {
  OnAxis,  ///< An axis of the part stays on an axis of the base: it slides along it and turns about it.
  InPlane,  ///< A flat face of the part stays in a plane, face to face: it slides in it and turns about its normal.
  ToPoint,  ///< A point of the part stays at a point of the base: it turns about it.
};

/// "axis", "plane" or "point": the kind's word in scene files and on the command line.
const char* wordOf(JointKind kind) noexcept;
/// The kind of a word; std::nullopt if it is none of these.
std::optional<JointKind> jointKindOf(std::string_view word) noexcept;

/// Point and direction of a feature that a joint keeps.
struct JointFeature {
  glm::dvec3 point{0.0};  ///< On the axis or in the plane [m].
  glm::dvec3 direction{0.0, 0.0,
                       1.0};  ///< Of the axis, or outward normal of the face; unit. Not used ToPoint.
  bool operator==(const JointFeature&) const = default;
};

/// Keeps a feature of a part on a feature of its base: another part, or the world.
struct Joint {
  JointId id{};
  JointKind kind = JointKind::OnAxis;
  PartId part{};               ///< The part that is kept.
  std::optional<PartId> base;  ///< std::nullopt: the world.
  JointFeature onPart;         ///< In the part's frame.
  JointFeature onBase;         ///< In the base's frame.
  bool isOn = true;            ///< A joint that is off is kept for later and does nothing.
  bool operator==(const Joint&) const = default;
};

/// Max joints of a part, on or off: three planes hold a part in all directions. Max joints of a scene: more than anyone
/// picks, and few enough that each undo step can keep a copy.
constexpr std::size_t kMaxJointsPerPart = 3, kMaxJoints = 1000;
/// Tolerance on the length of a direction: covers numbers typed or printed with four digits.
constexpr double kDirectionSlack = 1e-3;

/// Returns the direction normalised. Throws UsageError if it is not finite or off unit length by more than
/// kDirectionSlack.
glm::dvec3 checkedDirection(const glm::dvec3& direction);
/// Returns the joint with its directions normalised, or set to z where they are not used. Throws UsageError if a point
/// is not within kMaxPosition, or like checkedDirection().
Joint checkedJoint(const Joint& joint);

}  // namespace nearfit
