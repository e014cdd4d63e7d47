#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/haptics/haptic_settings.h"
#include "core/math/rigid_transform.h"
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
  bool isVisible = true;             ///< An invisible part is not felt either.
  /// A locked part cannot be moved, renamed, recoloured, made of another density, deleted, or be the
  /// moving part; it can be hidden.
  bool isLocked = false;
};

/// Parts and settings, as a value: copying it is cheap (parts are shared) and is how undo and threads keep
/// one. Each change happens whole or throws UsageError and changes nothing.
class Scene {
 public:
  using PartPtr = std::shared_ptr<const Part>;

  const std::vector<PartPtr>& parts() const noexcept { return parts_; }
  const Part* find(PartId id) const noexcept;
  const Part* findByName(std::string_view name) const noexcept;
  std::optional<PartId> movingPart() const noexcept { return movingPart_; }
  const HapticSettings& haptics() const noexcept { return haptics_; }

  /// Adds a copy of `part` with a fresh id; its name gets a number behind it when it is taken, its quaternion
  /// is normalised. Returns the id. Throws UsageError when name, pose, colour or density are none (see
  /// checkedPose).
  PartId add(Part part);
  /// Replaces the part of the same id. Throws UsageError when there is none, its new name is taken, it is the
  /// moving part and would be locked, or as add does.
  void replace(Part part);
  /// The moving part, when it is this one, becomes none. Throws UsageError when there is no such part.
  void remove(PartId id);
  /// Throws UsageError when the part is unknown or locked.
  void setMovingPart(std::optional<PartId> id);
  /// Throws UsageError as checkHaptics does (haptic_limits.h); the orientation is normalised.
  void setHaptics(const HapticSettings& haptics);

  /// Of all parts that have one, in their order; one that parts share stands there once for each.
  std::vector<PartGeometryPtr> geometries() const;

  /// A colour for the next part: the one of the palette that the fewest parts have.
  Colour nextColour() const noexcept;
  /// From now on gives no id that `other` may have given: undo must not bring back the id of another part.
  void retireIdsOf(const Scene& other) noexcept;

 private:
  std::string freeName(const std::string& wanted) const;
  std::size_t indexOf(PartId id) const;

  std::vector<PartPtr> parts_;
  std::optional<PartId> movingPart_;
  HapticSettings haptics_;
  std::uint32_t nextId_ = 1;
};

/// Of the part, from its density and the volume of its mesh [kg]; 0 when it has no geometry.
double massOf(const Part& part) noexcept;

/// Throws UsageError when it is not finite or out of its limits.
void checkDensity(double density);

/// Throws UsageError when the name is empty, too long, not UTF-8 or holds control characters.
void checkPartName(const std::string& name);

/// The pose with its quaternion normalised. Throws UsageError when a number is not finite, a coordinate is
/// beyond kMaxPosition, or the quaternion's length is off 1 by more than kQuaternionSlack.
RigidTransform checkedPose(const RigidTransform& pose);
/// How far off 1 a quaternion's length may be: covers numbers typed or printed with four digits, not slips.
constexpr double kQuaternionSlack = 1e-3;

}  // namespace nearfit
