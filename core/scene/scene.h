#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/haptics/spring_law.h"
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

struct Part {
  PartId id{};
  std::string name;  ///< Unique in its scene, not empty.
  PartGeometryPtr geometry;
  RigidTransform worldFromPart;
  Colour colour;
  bool isVisible = true;  ///< An invisible part is not felt either.
  bool isLocked = false;  ///< A locked part cannot be moved, renamed, deleted, or be the moving part.
};

/// Parts and settings, as a value: copying it is cheap (parts are shared) and is how undo and threads keep one.
class Scene {
 public:
  using PartPtr = std::shared_ptr<const Part>;

  const std::vector<PartPtr>& parts() const noexcept { return parts_; }
  const Part* find(PartId id) const noexcept;
  const Part* findByName(std::string_view name) const noexcept;
  std::optional<PartId> movingPart() const noexcept { return movingPart_; }
  const SpringParameters& springs() const noexcept { return springs_; }

  /// Adds a copy of `part` with a fresh id; its name gets a number behind it when it is taken. Returns the id.
  PartId add(Part part);
  /// Replaces the part of the same id. Throws UsageError when there is none or its new name is empty or taken.
  void replace(Part part);
  void remove(PartId id);
  /// Throws UsageError when the part is unknown or locked.
  void setMovingPart(std::optional<PartId> id);
  /// Throws UsageError when a value is not finite or out of its limits (see spring_limits.h).
  void setSprings(const SpringParameters& springs);

 private:
  std::string freeName(const std::string& wanted) const;

  std::vector<PartPtr> parts_;
  std::optional<PartId> movingPart_;
  SpringParameters springs_;
  std::uint32_t nextId_ = 1;
};

}  // namespace nearfit
