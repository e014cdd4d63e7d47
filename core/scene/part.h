#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/math/rigid_transform.h"
#include "core/scene/group.h"
#include "core/scene/part_geometry.h"

namespace nearfit {

/// Identifies a part within its scene; never reused.
enum class PartId : std::uint32_t {};

/// sRGB, each 0 to 1.
struct Colour {
  float r = 0.7F, g = 0.7F, b = 0.7F;
  bool operator==(const Colour&) const = default;
};

/// Colours for parts: of even lightness, distinguishable with the common forms of colour blindness, and less
/// saturated than the glyphs drawn over them.
/// Source: P. Tol, Colour schemes, 2021 (the "muted" set, lightened), with steel first for machine parts.
constexpr std::array<Colour, 10> kPartPalette{{
    {0.62F, 0.69F, 0.76F},  // steel
    {0.90F, 0.67F, 0.36F},  // brass
    {0.43F, 0.68F, 0.62F},  // teal
    {0.80F, 0.52F, 0.56F},  // rose
    {0.55F, 0.60F, 0.84F},  // periwinkle
    {0.72F, 0.74F, 0.42F},  // olive
    {0.69F, 0.50F, 0.72F},  // plum
    {0.53F, 0.80F, 0.90F},  // sky
    {0.72F, 0.56F, 0.44F},  // leather
    {0.86F, 0.83F, 0.58F},  // sand
}};

/// Max length of a part's name [bytes of UTF-8].
constexpr std::size_t kMaxPartNameBytes = 200;
/// Max distance from the origin along each axis [m], more than twice the distance to the moon. Beyond it,
/// double precision is coarser than a tenth of a micrometre, and the number is probably in the wrong unit.
constexpr double kMaxPosition = 1e9;

/// Density of a part whose material is not set: that of water and most plastics [kg/m^3].
constexpr double kDefaultDensity = 1000.0;
/// From a gas to fifty times the densest metal [kg/m^3]. A number beyond is probably in the wrong unit.
constexpr double kMinDensity = 1e-3, kMaxDensity = 1e6;

/// A named mesh with a pose in the scene.
struct Part {
  PartId id{};
  std::string name;  ///< Unique in its scene; not empty; UTF-8 without control characters.
  /// Mesh and derived data, in the part's frame; shared and immutable. May be null.
  PartGeometryPtr geometry;
  /// Pose; unit quaternion.
  RigidTransform worldFromPart;
  Colour colour;
  double density = kDefaultDensity;  ///< [kg/m^3]
  double opacity = 1.0;              ///< kMinOpacity to 1.
  /// Centre of rotation for the gizmo, in the part's frame [m]; std::nullopt: the centre of mass.
  std::optional<glm::dvec3> pivot;
  bool isVisible = true;  ///< An invisible part cannot be felt.
  /// Forbids moving, renaming, deleting and regrouping the part, changing its density, shape or pivot, and
  /// making it the moving part. Visibility, opacity and colour can still change. A group also locks its
  /// members; Scene::isLocked() covers both.
  bool isLocked = false;
  std::optional<GroupId> group;  ///< std::nullopt: at the top level.
  /// During isolation: isVisible before it. std::nullopt for parts added since, and outside isolation.
  std::optional<bool> wasVisible;
};

/// True if all fields are equal, including the id.
bool isSame(const Part& a, const Part& b) noexcept;

/// True if the parts differ at most in look (visibility, opacity, colour) and lock. A locked part may
/// change in this way.
bool differsOnlyInLookOrLock(const Part& a, const Part& b) noexcept;

/// Min opacity: a part that can be felt must stay visible.
constexpr double kMinOpacity = 0.05;

/// True if the part has a surface that can be near another one.
inline bool hasTriangles(const Part& part) noexcept {
  return part.geometry && !part.geometry->mesh.triangles().empty();
}

/// Mass from density and mesh volume [kg]; 0 without geometry.
double massOf(const Part& part) noexcept;

/// Throws UsageError if the value is not finite or out of range.
void checkDensity(double density);
/// Throws UsageError if the value is not between kMinOpacity and 1.
void checkOpacity(double opacity);
/// Throws UsageError if a channel is not between 0 and 1.
void checkColour(const Colour& colour);

/// Throws UsageError if the name is empty, too long, not UTF-8 or holds control characters.
void checkPartName(const std::string& name);

/// Throws UsageError if a coordinate is not finite or exceeds kMaxPosition.
void checkPosition(const glm::dvec3& position);
/// Returns the pose with its quaternion normalised. Throws UsageError like checkPosition(), or if the
/// quaternion's length differs from 1 by more than kQuaternionSlack.
RigidTransform checkedPose(const RigidTransform& pose);
/// Tolerance on the length of a quaternion: covers numbers typed or printed with four digits.
constexpr double kQuaternionSlack = 1e-3;

}  // namespace nearfit
