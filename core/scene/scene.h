#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/haptics/haptic_settings.h"
#include "core/scene/group.h"
#include "core/scene/part.h"

namespace nearfit {

/// Parts, their groups and settings, as a value: copying it is cheap (parts are shared) and is how undo and
/// threads keep one. Each change happens whole or throws UsageError and changes nothing.
class Scene {
 public:
  using PartPtr = std::shared_ptr<const Part>;
  using GroupPtr = std::shared_ptr<const Group>;

  /// Oldest first, which is by their ids.
  const std::vector<PartPtr>& parts() const noexcept { return parts_; }
  const Part* find(PartId id) const noexcept;
  const Part* findByName(std::string_view name) const noexcept;
  std::optional<PartId> movingPart() const noexcept { return movingPart_; }
  const HapticSettings& haptics() const noexcept { return haptics_; }

  /// Adds a copy of `part` with a fresh id; its name gets a number behind it when it is taken, its quaternion
  /// is normalised. Returns the id. Throws UsageError when name, pose, colour, density or opacity are none
  /// (see checkedPose), or its group is unknown or locked.
  PartId add(Part part);
  /// Replaces the part of the same id. Throws UsageError when there is none, its new name is taken, it is the
  /// moving part and would be locked, it is locked and would change (but for its look, see isSameButForLook,
  /// and what its mesh file has become), or as add does.
  void replace(Part part);
  /// The moving part, when it is this one, becomes none. Throws UsageError when there is no such part or it
  /// is locked.
  void remove(PartId id);
  /// Throws UsageError when the part is unknown or locked.
  void setMovingPart(std::optional<PartId> id);
  /// Throws UsageError as checkHaptics does (haptic_limits.h); the orientation is normalised.
  void setHaptics(const HapticSettings& haptics);

  /// Groups, oldest first; what is in which, core/scene/scene_tree.h tells.
  const std::vector<GroupPtr>& groups() const noexcept { return groups_; }
  const Group* findGroup(GroupId id) const noexcept;
  /// Adds a copy with a fresh id and returns that. Throws UsageError when the name is none, its parent is
  /// unknown or locked, or there would be more than kMaxGroups or kMaxGroupDepth of them.
  GroupId addGroup(Group group);
  /// Replaces the group of the same id. Throws UsageError when there is none, it would hold itself, it is
  /// locked and more than its own lock would change, it holds the moving part and would be locked, or as
  /// addGroup does.
  void replaceGroup(Group group);
  /// Throws UsageError when there is no such group, or it is locked or not empty.
  void removeGroup(GroupId id);

  /// Whether it or a group that it is in, at any depth, is locked.
  bool isLocked(const Part& part) const noexcept;
  bool isLocked(const Group& group) const noexcept;
  /// Throws UsageError when it is, naming what locks it.
  void requireUnlocked(const Part& part) const;
  void requireUnlocked(const Group& group) const;

  /// Shows these parts and no others, and remembers what was visible before, when that is not remembered yet.
  /// Throws UsageError when there are none, or one is unknown.
  void isolate(const std::vector<PartId>& parts);
  /// Shows exactly what was visible before; parts that came since stay as they are.
  void endIsolation();
  bool isIsolated() const noexcept;

  /// Of all parts that have one, in their order; one that parts share stands there once for each.
  std::vector<PartGeometryPtr> geometries() const;

  /// A colour for the next part: the one of the palette that the fewest parts have.
  Colour nextColour() const noexcept;
  /// From now on gives no id that `other` may have given: undo must not bring back the id of another part.
  void retireIdsOf(const Scene& other) noexcept;

 private:
  std::size_t indexOf(PartId id) const;
  std::size_t indexOf(GroupId id) const;
  /// The nearest that is locked, from there upwards; null when none is.
  const Group* lockAt(std::optional<GroupId> group) const noexcept;
  void requireOpen(std::optional<GroupId> group) const;
  /// Groups from there upwards.
  std::size_t depthOf(std::optional<GroupId> group) const noexcept;
  bool isWithin(std::optional<GroupId> group, GroupId ancestor) const noexcept;
  void checkPlace(const Group& group) const;

  std::vector<PartPtr> parts_;
  std::optional<PartId> movingPart_;
  HapticSettings haptics_;
  std::vector<GroupPtr> groups_;
  std::uint32_t nextId_ = 1, nextGroupId_ = 1;
};

}  // namespace nearfit
