#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/math/rigid_transform.h"
#include "core/scene/group.h"
#include "core/scene/part_geometry.h"

namespace nearfit {

/// Names a part for as long as its scene lives; never used again after the part is deleted.
enum class PartId : std::uint32_t {};

/// sRGB, each 0 to 1.
struct Colour {
  float r = 0.7F, g = 0.7F, b = 0.7F;
  bool operator==(const Colour&) const = default;
};

/// Longest name of a part [bytes of UTF-8].
constexpr std::size_t kMaxPartNameBytes = 200;
/// Farthest from the origin that a part may stand on each axis [m]: to the moon and back. Beyond it double
/// precision is coarser than a tenth of a micrometre, and the number is a slip of the unit.
constexpr double kMaxPosition = 1e9;

/// Of a part of which nobody has said what it is made of: water's, and most plastics' [kg/m^3].
constexpr double kDefaultDensity = 1000.0;
/// From a gas to fifty times the densest metal [kg/m^3]; beyond them a number is a slip of the unit.
constexpr double kMinDensity = 1e-3, kMaxDensity = 1e6;

struct Part {
  PartId id{};
  std::string name;  ///< Unique in its scene, not empty; UTF-8 without control characters.
  PartGeometryPtr geometry;
  RigidTransform worldFromPart;
  Colour colour;
  double density = kDefaultDensity;  ///< [kg/m^3]
  double opacity = 1.0;              ///< kMinOpacity to 1.
  /// What the gizmo turns it about, in its own frame [m]; none: its centre of mass.
  std::optional<glm::dvec3> pivot;
  bool isVisible = true;  ///< An invisible part is not felt either.
  /// A locked part cannot be moved, renamed, made of another density or shape, given another pivot, put into
  /// another group, deleted, or be the moving part; how it is shown (hidden, transparent, its colour) can be
  /// changed. A group locks what it holds: Scene::isLocked says whether a part is locked for either reason.
  bool isLocked = false;
  std::optional<GroupId> group;  ///< None: it stands at the top.
  /// While parts are isolated: whether it was visible before. Empty for parts that came since.
  std::optional<bool> wasVisible;
};

/// Whether nothing of a part differs from another, its id included.
bool isSame(const Part& a, const Part& b) noexcept;

/// Whether two states of a part differ at most in how it is shown and in the lock itself: a locked one may
/// become the other.
bool isSameButForLook(const Part& a, const Part& b) noexcept;

/// The faintest that a part is drawn: one that is felt must be seen.
constexpr double kMinOpacity = 0.05;

/// Of the part, from its density and the volume of its mesh [kg]; 0 when it has no geometry.
double massOf(const Part& part) noexcept;

/// Throws UsageError when it is not finite or out of its limits.
void checkDensity(double density);
void checkOpacity(double opacity);
void checkColour(const Colour& colour);

/// Throws UsageError when the name is empty, too long, not UTF-8 or holds control characters.
void checkPartName(const std::string& name);

/// Throws UsageError when a coordinate is not finite or beyond kMaxPosition.
void checkPosition(const glm::dvec3& position);
/// The pose with its quaternion normalised. Throws UsageError as checkPosition does, or when the
/// quaternion's length is off 1 by more than kQuaternionSlack.
RigidTransform checkedPose(const RigidTransform& pose);
/// How far off 1 a quaternion's length may be: covers numbers typed or printed with four digits, not slips.
constexpr double kQuaternionSlack = 1e-3;

}  // namespace nearfit
