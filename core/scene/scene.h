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
#include "core/scene/joint.h"
#include "core/scene/names.h"
#include "core/scene/pair_record.h"
#include "core/scene/pair_rule.h"
#include "core/scene/part.h"

namespace nearfit {

class GroupBodies;

/// Parts, groups, joints, haptic settings, and rules and records of checks, as a value. Copies are cheap because
/// they share parts and groups; undo and threads keep copies. Each change either succeeds as a whole or throws
/// UsageError and changes nothing.
class Scene {
 public:
  using PartPtr = std::shared_ptr<const Part>;
  using GroupPtr = std::shared_ptr<const Group>;

  /// Oldest first, in ascending order of ID.
  const std::vector<PartPtr>& parts() const noexcept { return parts_; }
  /// The part with this ID; null if there is none. Valid until the part changes. O(log n).
  const Part* find(PartId id) const noexcept;
  /// The same; throws UsageError if there is none.
  const Part& get(PartId id) const;
  /// The part with this name; null if there is none. Valid until the part changes. O(n).
  const Part* findByName(std::string_view name) const noexcept;
  /// The part that can be taken in hand; of a moving group the part that leads, in whose frame its pose is given.
  std::optional<PartId> movingPart() const noexcept { return movingPart_; }
  /// The group whose parts the hand moves as one; std::nullopt if it moves one part, or none.
  std::optional<GroupId> movingGroup() const noexcept { return movingGroup_; }
  /// True if the hand moves the part: it is the moving part, or in the moving group at any depth.
  bool isMoving(PartId id) const noexcept;
  /// All parts that the hand moves, in scene order; empty if nothing is in hand. O(n).
  std::vector<PartId> movingParts() const;
  /// Geometries made of the moving group (moving_body.h), shared with copies; null if a group was never in hand.
  const std::shared_ptr<GroupBodies>& groupBodies() const noexcept { return groupBodies_; }
  const HapticSettings& haptics() const noexcept { return haptics_; }

  /// Adds a copy of `part` with a new ID and returns the ID. Appends a number to a name already taken;
  /// normalises the quaternion. Throws UsageError if name, pose (see checkedPose), colour, density or opacity
  /// is invalid, or the group is unknown or locked.
  PartId add(Part part);
  /// Adds copies of all these parts, in their order, each like add(); of two with one name the later gets the
  /// number. O((n + m) log(n + m)) for m parts beside n.
  std::vector<PartId> addAll(std::vector<Part> parts);
  /// Replaces the part with the same ID. Rules for pairs that name this part alone follow a new name. Throws UsageError
  /// like add(), or if there is no such part, its new
  /// name is taken, the hand moves it and it would be locked, or it is locked and more than its look (see
  /// differsOnlyInLookOrLock) or geometry would change.
  void replace(Part part);
  /// Removes a part, with the joints that keep it and those that keep others on it, and the records of its pairs.
  /// If it is the moving part, the scene has none afterwards; if it leads a moving group, another member leads.
  /// Throws UsageError if the part is unknown or locked.
  void remove(PartId id);
  /// Sets the moving part; std::nullopt for none. Throws UsageError if the part is unknown or locked.
  void setMovingPart(std::optional<PartId> id);
  /// Makes all parts in a group move as one. Its first part with a geometry leads. The group is no longer in hand once
  /// its last part leaves it. Throws UsageError if the group is unknown, has no part, or it or something in it is
  /// locked.
  void setMovingGroup(GroupId id);
  /// Sets the haptic settings, the orientation normalised. Throws UsageError like checkHaptics()
  /// (haptic_limits.h).
  void setHaptics(const HapticSettings& haptics);

  /// Groups, oldest first; for their members see core/scene/scene_tree.h.
  const std::vector<GroupPtr>& groups() const noexcept { return groups_; }
  /// The group with this ID; null if there is none. Valid until the group changes. O(log n).
  const Group* findGroup(GroupId id) const noexcept;
  /// Adds a copy of `group` with a new ID and returns the ID. Throws UsageError if the name is invalid, the
  /// parent is unknown or locked, or kMaxGroups or kMaxGroupDepth would be exceeded.
  GroupId addGroup(Group group);
  /// Adds groups, oldest first, any of which may hold others of them. Returns their IDs in that order. Throws UsageError like
  /// addGroup(), also if one would contain itself. O(n) times the depth.
  /// @param parents  For each the index of its parent among them; std::nullopt: the top level.
  std::vector<GroupId> addGroups(std::vector<Group> added,
                                 const std::vector<std::optional<std::size_t>>& parents);
  /// Replaces the group with the same ID. Throws UsageError like addGroup(), or if there is no such
  /// group, it would contain itself, it is locked and more than its own lock would change, or it would
  /// lock a part that the hand moves.
  void replaceGroup(Group group);
  /// Removes an empty group. Throws UsageError if it is unknown, locked or not empty.
  void removeGroup(GroupId id);

  /// Joints, oldest first.
  const std::vector<Joint>& joints() const noexcept { return joints_; }
  /// The joint with this ID; null if there is none. Valid until a joint changes. O(log n).
  const Joint* findJoint(JointId id) const noexcept;
  /// The same; throws UsageError if there is none.
  const Joint& getJoint(JointId id) const;
  /// Adds a joint with a new ID and returns the ID. Its part stays where it is, on the joint or off it. Throws
  /// UsageError if part or base is unknown, they are the same, the part is locked, a point or direction is invalid
  /// (see checkedJoint), or kMaxJointsPerPart or kMaxJoints would be exceeded.
  JointId addJoint(Joint joint);
  /// Replaces the joint with the same ID. Throws UsageError like addJoint(), or if there is no such joint or the part
  /// that it has kept so far is locked.
  void replaceJoint(Joint joint);
  /// Removes a joint. Throws UsageError if it is unknown or its part is locked.
  void removeJoint(JointId id);
  /// Scales the points that joints have on a part, as its mesh was, also those of locked parts: the mesh decides.
  /// Throws UsageError if one would not be within kMaxPosition.
  void scaleJointsOn(PartId part, double factor);
  /// Scales the points in the world that joints keep a part on, about the world's origin, as its position was. Throws
  /// UsageError like scaleJointsOn().
  void scaleWorldJointsOf(PartId part, double factor);

  /// Rules for pairs of parts in a check of the scene, in the order of the user.
  const std::vector<PairRule>& pairRules() const noexcept;
  /// Throws UsageError like checkPairRules().
  void setPairRules(std::vector<PairRule> rules);
  /// Findings of the last check, in ascending order of pairs.
  const std::vector<PairRecord>& pairRecords() const noexcept;
  /// The record of a pair; null if there is none. Valid until records change. O(log n).
  const PairRecord* findPairRecord(const PartPair& pair) const noexcept;
  /// Sets all records, in any order. Throws UsageError like checkPairRecord(), or if there are more than kMaxPairRecords,
  /// two of one pair, or one of an unknown part.
  void setPairRecords(std::vector<PairRecord> records);
  /// Sets what the user says about findings. Throws UsageError if one of the pairs has no record, or like
  /// checkPairRecord().
  /// @param reason  Why they are accepted; else may be empty.
  void setFindingState(const std::vector<PartPair>& pairs, FindingState state, const std::string& reason);

  /// True if it, or a group that contains it at any depth, is locked.
  bool isLocked(const Part& part) const noexcept;
  bool isLocked(const Group& group) const noexcept;
  /// Throws UsageError if it is locked, naming what locks it.
  void requireUnlocked(const Part& part) const;
  void requireUnlocked(const Group& group) const;

  /// Shows only these parts. The first call remembers the previous visibility. Throws UsageError if `parts`
  /// is empty or one is unknown.
  void isolate(const std::vector<PartId>& parts);
  /// Restores the visibility from before isolate(). Parts added since stay as they are.
  void endIsolation();
  /// True between isolate() and endIsolation().
  bool isIsolated() const noexcept;

  /// Non-null geometries of all parts, in part order; a shared one appears once per part.
  std::vector<PartGeometryPtr> geometries() const;

  /// The palette colour that the fewest parts have. O(n).
  Colour nextColour() const noexcept;
  /// The colours of `count` parts that each get nextColour() when added. O(n + count).
  std::vector<Colour> nextColours(std::size_t count) const;
  /// Retires all IDs that `other` has given out, so that IDs stay unique across undo.
  void retireIdsOf(const Scene& other) noexcept;

 private:
  std::size_t indexOf(PartId id) const;
  /// Throws UsageError if the part cannot be added; normalises its pose.
  void makeAddable(Part& part) const;
  PartId append(Part part);
  TakenNames takenNames() const;
  std::size_t indexOf(GroupId id) const;
  /// Nearest locked group, from `group` upward; null if none.
  const Group* lockAt(std::optional<GroupId> group) const noexcept;
  void requireOpen(std::optional<GroupId> group) const;
  /// Number of groups from `group` upward, itself included.
  std::size_t depthOf(std::optional<GroupId> group) const noexcept;
  bool isWithin(std::optional<GroupId> group, GroupId ancestor) const noexcept;
  /// Throws UsageError if the group holds what the hand moves, or is in the moving group.
  void requireNotMoving(const Group& group) const;
  /// Lets another member of the moving group lead if the one that did has left.
  void keepLead() noexcept;
  void checkPlace(const Group& group) const;
  std::size_t indexOf(JointId id) const;
  /// Throws UsageError if the scene cannot hold the joint; normalises its directions.
  Joint checkedForScene(const Joint& joint) const;
  void dropRecordsOf(PartId id);
  /// Lets rules that name a part alone follow its new name.
  void renameInRules(const std::string& from, const std::string& to);

  std::vector<PartPtr> parts_;
  std::optional<PartId> movingPart_;
  std::optional<GroupId> movingGroup_;
  std::shared_ptr<GroupBodies> groupBodies_;
  HapticSettings haptics_;
  std::vector<GroupPtr> groups_;
  std::vector<Joint> joints_;
  std::shared_ptr<const std::vector<PairRule>> pairRules_;      ///< Null: none.
  std::shared_ptr<const std::vector<PairRecord>> pairRecords_;  ///< Null: none.
  std::uint32_t nextId_ = 1, nextGroupId_ = 1, nextJointId_ = 1;
};

}  // namespace nearfit
