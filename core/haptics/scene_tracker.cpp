#include "core/haptics/scene_tracker.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace nearfit {
namespace {

/// How much farther than the lists' budget other bodies must be clear: looking at them again is cheap, but a
/// body that is listed costs every tick a little.
constexpr double kClearance = 8.0;

bool isBefore(const TrackedScene::Near& a, const TrackedScene::Near& b) noexcept {
  return a.body < b.body;
}

}  // namespace

void SceneTracker::setScene(std::shared_ptr<const ServoScene> scene) {
  TrackedScene next = untracked(std::move(scene));
  const auto isSame = [](const ServoScene::Body& a, const ServoScene::Body& b) {
    return a.id == b.id && a.geometry == b.geometry;
  };
  if (current_.scene && isSame(current_.scene->moving, next.scene->moving)) {
    for (const TrackedScene::Near& entry : current_.near) {
      const ServoScene::Body& body = current_.scene->bodies[entry.body];
      const auto found = std::find_if(next.scene->bodies.begin(), next.scene->bodies.end(),
                                      [&](const ServoScene::Body& b) { return isSame(b, body); });
      if (found == next.scene->bodies.end()) continue;
      next.near.push_back({static_cast<std::uint32_t>(found - next.scene->bodies.begin()), entry.list});
    }
    std::sort(next.near.begin(), next.near.end(), isBefore);
  } else if (next.scene->moving.geometry) {
    const Aabb& box = next.scene->moving.geometry->mesh.bounds();
    forecast_ = MotionForecast(box.centre(), 0.5 * box.diagonal());
    forecast_.observe(next.scene->moving.worldFromPart, 1.0);
  }
  current_ = std::move(next);
}

TrackedPair SceneTracker::pairOf(std::uint32_t index) const noexcept {
  const ServoScene::Body& body = current_.scene->bodies[index];
  return {body.geometry->tree(), current_.scene->moving.geometry->tree(), body.worldFromPart};
}

bool SceneTracker::willServe(const TrackedScene::Near& entry, double cutoff) const noexcept {
  return nearfit::willServe(*entry.list, pairOf(entry.body), forecast_, cutoff);
}

bool SceneTracker::isDue(double cutoff) const noexcept {
  if (!current_.scene || !current_.scene->moving.geometry) return false;
  if (current_.cutoff != cutoff || !(current_.spent(forecast_.pose(), cutoff) <= 1.0) ||
      !(current_.spent(forecast_.poseWhenReady(), cutoff) <= 1.0)) {
    return true;
  }
  return std::any_of(current_.near.begin(), current_.near.end(), [&](const TrackedScene::Near& entry) {
    return entry.list && !willServe(entry, cutoff);
  });
}

void SceneTracker::refresh(double cutoff, TrackedScene& out) {
  if (current_.scene->moving.geometry) {
    const SearchPlan plan = forecast_.plan(cutoff);
    const double radius = 0.5 * current_.scene->moving.geometry->mesh.bounds().diagonal();
    const std::vector<TrackedScene::Near> former = std::exchange(current_.near, {});
    current_.worldFromPart = plan.pose;
    current_.cutoff = 0.0;  // Should memory run out below, nothing is known.
    const auto wide =
        std::find_if(std::begin(kWideClearances), std::end(kWideClearances), [&](double factor) {
          current_.clear = clearance(factor, plan, radius);
          return isAllClear(cutoff, former);
        });
    if (wide == std::end(kWideClearances)) {
      current_.clear = clearance(kClearance, plan, radius);
      findNear(cutoff, former);
    }
    current_.cutoff = cutoff;
  }
  out = current_;
}

bool SceneTracker::isClearOf(const BodyPairQuery& query) noexcept {
  // A pose that is no pose is for the tick to refuse.
  return query.sceneFromPart.isFinite() && isClearWithin(query, current_.clear, scratch_, kClearNodePairs);
}

bool SceneTracker::isAllClear(double cutoff, const std::vector<TrackedScene::Near>& former) noexcept {
  const auto isClear = [&](std::uint32_t body) {
    return isClearOf(pairOf(body).queryAt(current_.worldFromPart, cutoff));
  };
  // What was near most likely still is, and is asked before the thousands that so wide a sphere may hold.
  if (!std::all_of(former.begin(), former.end(), [&](const auto& entry) { return isClear(entry.body); }))
    return false;
  const MovingBounds moving = movingBounds(*current_.scene, current_.worldFromPart);
  return current_.bounds->isEachNear(moving.centre, moving.radius + cutoff + current_.clear.travel, isClear);
}

void SceneTracker::findNear(double cutoff, const std::vector<TrackedScene::Near>& former) {
  const MovingBounds moving = movingBounds(*current_.scene, current_.worldFromPart);
  current_.bounds->visitNear(moving.centre, moving.radius + cutoff + current_.clear.travel,
                             [&](std::uint32_t body) {
                               current_.near.push_back({body, nullptr});
                             });
  std::sort(current_.near.begin(), current_.near.end(), isBefore);
  std::erase_if(current_.near, [&](TrackedScene::Near& entry) {
    const auto old = std::lower_bound(former.begin(), former.end(), entry, isBefore);
    if (old != former.end() && old->body == entry.body && old->list && willServe(*old, cutoff)) {
      entry.list = old->list;
      return false;
    }
    const TrackedPair pair = pairOf(entry.body);
    if (isClearOf(pair.queryAt(current_.worldFromPart, cutoff))) return true;
    const std::shared_ptr<CandidateList> list = spareList();
    buildForPlan(*list, pair, forecast_, cutoff, scratch_);
    if (list->isUsable()) entry.list = list;
    return false;
  });
}

std::shared_ptr<CandidateList> SceneTracker::spareList() {
  // Counts change on this thread alone: the servo thread never copies a list.
  for (const std::shared_ptr<CandidateList>& list : pool_) {
    if (list.use_count() == 1) return list;
  }
  return pool_.emplace_back(std::make_shared<CandidateList>());
}

}  // namespace nearfit
