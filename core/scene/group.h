#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace nearfit {

/// Names a group for as long as its scene lives; never used again after the group is deleted.
enum class GroupId : std::uint32_t {};

/// Groups of a scene: a node holds at most so many above it, and a scene so many at all.
constexpr std::size_t kMaxGroupDepth = 32, kMaxGroups = 10'000;
/// Longest name of a group [bytes of UTF-8].
constexpr std::size_t kMaxGroupNameBytes = 200;

/// Parts and groups that belong together. What it holds says so itself, by Part::group and Group::parent.
struct Group {
  GroupId id{};
  std::string name;               ///< As of a part, but others may have the same.
  std::optional<GroupId> parent;  ///< None: it stands at the top.
  /// What a locked group holds is locked, to any depth, and nothing goes in or out.
  bool isLocked = false;
  bool operator==(const Group&) const = default;
};

/// Throws UsageError when the name is empty, too long, not UTF-8 or holds control characters.
void checkGroupName(const std::string& name);

}  // namespace nearfit
