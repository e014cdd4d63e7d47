#include "core/servo/path_run.h"

#include <chrono>
#include <utility>

#include "core/base/error.h"
#include "core/servo/scene_tracker.h"
#include "core/servo/tracked_scene.h"

namespace nearfit {
namespace {

using RunClock = std::chrono::steady_clock;

double runSecondsSince(RunClock::time_point begin) {
  return std::chrono::duration<double>(RunClock::now() - begin).count();
}

}  // namespace

Scene withInHandAt(Scene scene, PartId part, const std::optional<RigidTransform>& start,
                   const std::string& where) {
  Part placed = scene.get(part);
  if (scene.isLocked(placed))
    throw UsageError(where, "part \"" + placed.name + "\" is locked", "unlock it, or choose another");
  if (!placed.isVisible) {
    throw UsageError(where, "part \"" + placed.name + "\" is hidden, so it would feel nothing",
                     "show it, or choose another");
  }
  if (start) placed.worldFromPart = *start;
  scene.replace(std::move(placed));
  scene.setMovingPart(part);
  return scene;
}

std::size_t runAlongPath(std::shared_ptr<const ServoScene> scene, const ServoParameters& parameters,
                         std::span<const RigidTransform> path, double period,
                         const std::function<bool(const PathTick&)>& take) {
  if (path.empty()) throw UsageError("path", "it has no poses", "give at least one");
  RigidTransform worldFromPart = scene->moving.worldFromPart;
  SceneTracker tracker;
  tracker.setScene(std::move(scene));
  TrackedScene tracked;
  ServoTick tick;
  const auto snapshot = std::make_unique<ServoSnapshot>();
  const SearchReach reach = searchReach(parameters.haptics);
  const bool isProxy = parameters.haptics.mode == HapticMode::Proxy;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const HandleInput handle{.pose = path[i]};
    // There is no search thread: what is due is searched before the tick, around the part. With springs the
    // part is where the hand wants it, and nothing is late.
    TickObservation observation = observationOf(*snapshot);
    observation.worldFromPart = isProxy ? worldFromPart : handle.pose;
    if (i == 0) observation.worldFromHand.reset();
    tracker.update(observation, 1.0);
    std::optional<double> refreshTime;
    if (i == 0 || tracker.isDue(reach)) {
      const RunClock::time_point begin = RunClock::now();
      tracker.refresh(reach, tracked);
      refreshTime = runSecondsSince(begin);
    }
    const RunClock::time_point begin = RunClock::now();
    tick.run(tracked, parameters, handle, period, *snapshot);
    snapshot->tickTime = runSecondsSince(begin);
    snapshot->time = static_cast<double>(i) * period;
    snapshot->tick = i + 1;
    worldFromPart = snapshot->proxy;
    if (!take({.snapshot = *snapshot, .refreshTime = refreshTime})) return i + 1;
  }
  return path.size();
}

}  // namespace nearfit
