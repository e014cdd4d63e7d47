#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace nearfit {

/// Identifies a group within its scene; never reused.
enum class GroupId : std::uint32_t {};

/// Max nesting depth of groups, and max number of groups in a scene.
constexpr std::size_t kMaxGroupDepth = 32, kMaxGroups = 10'000;
/// Max length of a group's name [bytes of UTF-8].
constexpr std::size_t kMaxGroupNameBytes = 200;

/// A set of parts and groups. Members refer to their group by Part::group and Group::parent.
struct Group {
  GroupId id{};
  std::string name;               ///< Same rules as a part's, but need not be unique.
  std::optional<GroupId> parent;  ///< std::nullopt: at the top level.
  /// Locks all members, to any depth. Nothing can be moved into or out of a locked group.
  bool isLocked = false;
  bool operator==(const Group&) const = default;
};

/// Throws UsageError if the name is empty, too long, not UTF-8 or holds control characters.
void checkGroupName(const std::string& name);

}  // namespace nearfit
