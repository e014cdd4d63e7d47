#include "core/haptics/motion_freedom.h"

#include <array>
#include <cstddef>

namespace nearfit {
namespace {

using Locks = std::array<bool, 3>;

struct SixLocks {
  Locks translation{}, rotation{};
  bool operator==(const SixLocks&) const = default;
};

constexpr Locks kNone{}, kAll{true, true, true};

constexpr Locks allBut(std::size_t axis) {
  Locks locks = kAll;
  locks[axis] = false;
  return locks;
}

constexpr Locks only(std::size_t axis) {
  Locks locks{};
  locks[axis] = true;
  return locks;
}

/// In the order of MotionFreedom, without Other.
constexpr std::array<SixLocks, kMotionFreedoms - 1> kLocks = {{{kNone, kNone},
                                                               {only(2), allBut(2)},
                                                               {only(0), allBut(0)},
                                                               {only(1), allBut(1)},
                                                               {allBut(0), kAll},
                                                               {allBut(1), kAll},
                                                               {allBut(2), kAll},
                                                               {kNone, kAll},
                                                               {kAll, kNone}}};

}  // namespace

WorkspaceMapping withFreedom(const WorkspaceMapping& mapping, MotionFreedom freedom) noexcept {
  WorkspaceMapping next = mapping;
  const auto index = static_cast<std::size_t>(freedom);
  if (index >= kLocks.size()) return next;
  next.translationLocks = kLocks[index].translation;
  next.rotationLocks = kLocks[index].rotation;
  return next;
}

MotionFreedom freedomOf(const WorkspaceMapping& mapping) noexcept {
  const SixLocks locks{mapping.translationLocks, mapping.rotationLocks};
  for (std::size_t i = 0; i < kLocks.size(); ++i) {
    if (kLocks[i] == locks) return static_cast<MotionFreedom>(i);
  }
  return MotionFreedom::Other;
}

}  // namespace nearfit
