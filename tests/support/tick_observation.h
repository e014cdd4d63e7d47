#pragma once

#include <optional>

#include "core/servo/scene_tracker.h"

namespace nearfit::test {

/// A part at a pose, whose hand is unknown and which waits for nothing.
inline TickObservation partAt(const RigidTransform& worldFromPart) {
  return {worldFromPart, std::nullopt, false, false};
}

}  // namespace nearfit::test
