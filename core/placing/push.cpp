#include "core/placing/push.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/math/aabb.h"
#include "core/placing/drop.h"
#include "core/placing/solid_move.h"

namespace nearfit {
namespace {

/// Ticks between two progress reports, and max ticks of a push.
constexpr int kBetweenReports = 20, kMaxTicks = 4 * SolidMove::kMaxTicks;

/// The extent of everything visible: a part that has moved this far is past it all [m].
double wholeWay(const Scene& scene) {
  Aabb box;
  double size = 0.0;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (!part->isVisible || part->geometry == nullptr) continue;
    const Aabb& bounds = part->geometry->mesh.bounds();
    box.add(part->worldFromPart.applyToPoint(0.5 * (bounds.lower + bounds.upper)));
    size += bounds.diagonal();
  }
  return box.diagonal() + size;
}

std::vector<RigidTransform> posesOf(const Scene& scene, std::span<const PartId> moved) {
  std::vector<RigidTransform> poses;
  for (const PartId id : moved)
    poses.push_back(scene.find(id)->worldFromPart);
  return poses;
}

Scene shifted(const Scene& scene, std::span<const PartId> moved, const glm::dvec3& shift) {
  Scene result = scene;
  for (const PartId id : moved) {
    Part part = *result.find(id);
    part.worldFromPart.translation += shift;
    result.replace(std::move(part));
  }
  return result;
}

/// Sorts touched parts: those that block the direction first, nearest first.
std::vector<PartId> barringFirst(const Scene& scene, std::span<const PartId> moved,
                                 const std::vector<RigidTransform>& poses, std::vector<PartId> touched,
                                 const glm::dvec3& direction) {
  std::map<PartId, double> ways;
  for (const PartId id : touched) {
    Scene alone = scene;
    for (const Scene::PartPtr& part : scene.parts()) {
      Part changed = *part;
      changed.isVisible = changed.id == id;
      alone.replace(std::move(changed));
    }
    for (std::size_t i = 0; i < moved.size(); ++i) {
      Part part = *alone.find(moved[i]);
      part.worldFromPart = poses[i];
      alone.replace(std::move(part));
    }
    const DropResult drop = dropParts(alone, moved, {direction, 0.0});
    const bool bars = drop.outcome != DropResult::Outcome::NothingMet;
    ways[id] = bars ? drop.travel : std::numeric_limits<double>::infinity();
  }
  std::ranges::stable_sort(touched, {}, [&ways](PartId id) { return ways.at(id); });
  return touched;
}

}  // namespace

PushResult pushParts(const Scene& scene, std::span<const PartId> moved, const glm::dvec3& direction,
                     const ProgressCallback& progress) {
  const DropResult drop = dropParts(scene, moved, {direction, 0.0},
                                    [&](double fraction) { return !progress || progress(0.5 * fraction); });
  PushResult result;
  result.poses = posesOf(scene, moved);
  if (drop.outcome == DropResult::Outcome::NothingMet) return result;
  result.against = {drop.against};
  result.outcome = PushResult::Outcome::Overlapping;
  if (drop.outcome == DropResult::Outcome::Overlapping) return result;

  SolidMove move(shifted(scene, moved, drop.shift), moved);
  RigidTransform wanted;
  wanted.translation = wholeWay(scene) * glm::normalize(direction);
  SolidMove::Progress reached;
  for (int ticks = 0; ticks < kMaxTicks && !reached.isSettled; ticks += kBetweenReports) {
    reached = move.advance(wanted, kBetweenReports);
    const double share = static_cast<double>(ticks) / kMaxTicks;
    if (progress && !progress(0.5 + 0.5 * share)) throw Cancelled();
  }
  if (reached.hasArrived || !reached.isSettled) {
    result.outcome = PushResult::Outcome::SlippedPast;
    return result;
  }
  result.outcome = PushResult::Outcome::Held;
  result.poses = move.poses();
  if (const std::vector<PartId> touching = move.touching(); !touching.empty())
    result.against = barringFirst(scene, moved, result.poses, touching, direction);
  return result;
}

}  // namespace nearfit
