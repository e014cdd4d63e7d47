#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/math/rigid_transform.h"
#include "core/scene/scene.h"
#include "core/servo/servo_scene.h"
#include "core/servo/servo_snapshot.h"
#include "core/servo/servo_tick.h"

namespace nearfit {

/// The scene with a part in hand.
/// @param start  Where it starts; std::nullopt: where it is.
/// @param where  Names the scene in errors.
/// Throws UsageError if the part is locked or hidden, or the start is invalid (checkedPose).
Scene withInHandAt(Scene scene, PartId part, const std::optional<RigidTransform>& start,
                   const std::string& where);

/// A tick of a run along a path.
struct PathTick {
  const ServoSnapshot& snapshot;
  /// Duration of the search ahead before the tick [s]; no value if none was due.
  std::optional<double> refreshTime;
};

/// Runs the servo with the part in hand along a path, one pose each tick, as fast as possible and on this thread. All but
/// the times is the same in each run.
/// @param path    worldFromHandle; not empty.
/// @param period  Of a tick, as the servo takes it to be [s].
/// @param take    Called after each tick; false ends the run.
/// Returns the number of ticks. Throws UsageError if the path is empty, and what `take` throws.
std::size_t runAlongPath(std::shared_ptr<const ServoScene> scene, const ServoParameters& parameters,
                         std::span<const RigidTransform> path, double period,
                         const std::function<bool(const PathTick&)>& take);

}  // namespace nearfit
