#include "core/servo/scene_tracker.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <utility>

#include <glm/geometric.hpp>

#include "core/servo/contact_finder.h"
#include "core/servo/overlap_check.h"

namespace nearfit {
namespace {

/// Other bodies must be clear by this multiple of the lists' budget: looking at them again is cheap, but
/// every listed body costs each tick a little.
constexpr double kClearance = 8.0;

/// Unique among all trackers.
std::uint64_t nextSerial() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

/// Max pairs of a list of triangles, and max work to find them, some 1.5 ms.
constexpr std::size_t kMaxListedTriangles = std::size_t{1} << 12;
constexpr std::uint64_t kMaxListingWork = std::uint64_t{1} << 14;
/// The same for a part that is starved, which a tick cannot search for by itself: some 20 ms, beside the servo.
constexpr std::size_t kMaxListedIfStarved = ContactFinder::kMaxSurfaceWork;
constexpr std::uint64_t kMaxListingWorkIfStarved = std::uint64_t{1} << 18;
/// Room for motion that a list of triangles has at least, if it can be made, and below which none is made [reaches].
constexpr double kUsualTriangleRoom = 8.0, kLeastTriangleRoom = 1.0;
/// Share of that room that must be left at a pose, and for a part that is starved.
constexpr double kTriangleRoomToKeep = 0.5, kTriangleRoomIfStarved = 0.98;

/// Beyond so many pairs of nodes, some 2.5 ms, a search for contacts is worth a list that serves long.
constexpr std::uint64_t kLongSearch = 1U << 15;
/// Such a list begins so many ticks before the former one ends, if it is ready then,
constexpr double kOverlap = 2.0;
/// and its pairs are claimed where the part has come so far on the former one's way.
constexpr double kShareAtClaim = 0.9;
/// Max bodies whose pairs are prepared.
constexpr std::size_t kMaxPrepared = 2;

/// With springs no force depends on what overlaps: it is only shown, some hundred times a second. So it is looked at anew
/// after that many ticks at the earliest, once that share of its room for motion is spent.
constexpr double kTicksBetweenShownClearances = 8.0;
constexpr double kShownClearanceToSpend = 0.5;

/// A list of the pool that is not in use, or a new one.
template <class List>
std::shared_ptr<List> spareOf(std::vector<std::shared_ptr<List>>& pool) {
  // Only this thread changes the counts: the servo thread never copies a list.
  for (const std::shared_ptr<List>& list : pool) {
    if (list.use_count() == 1) return list;
  }
  return pool.emplace_back(std::make_shared<List>());
}

bool isBefore(const TrackedScene::Near& a, const TrackedScene::Near& b) noexcept {
  return a.body < b.body;
}

}  // namespace

TickObservation observationOf(const ServoSnapshot& snapshot) noexcept {
  return {snapshot.proxy, snapshot.handle, snapshot.isWaiting, snapshot.isStarved, snapshot.isCrowded};
}

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
      next.near.push_back({static_cast<std::uint32_t>(found - next.scene->bodies.begin()), entry.list,
                           entry.contacts, found->surface ? entry.triangles : nullptr, entry.prepared,
                           entry.formerPrepared});
    }
    std::sort(next.near.begin(), next.near.end(), isBefore);
  } else if (next.scene->moving.geometry) {
    const Aabb& box = next.scene->moving.geometry->mesh.bounds();
    forecast_ = hand_ = MotionForecast(box.centre(), 0.5 * box.diagonal());
    steady_ = steadyHand_ = MotionForecast::steady(box.centre(), 0.5 * box.diagonal());
    forecast_.observe(next.scene->moving.worldFromPart, 1.0);
  }
  current_ = std::move(next);
  for (BodyPreparer& of : preparers_)
    of.body.reset();
  memory_.assign(current_.scene->bodies.size(), {});
}

void SceneTracker::update(const TickObservation& tick, double ticks) noexcept {
  forecast_.observe(tick.worldFromPart, ticks);
  clearanceAge_ += ticks;
  if (tick.worldFromHand) {
    hand_.observe(*tick.worldFromHand, ticks);
    steadyHand_.observe(*tick.worldFromHand, ticks);
  }
  steady_.observe(tick.worldFromPart, ticks);
  isWaiting_ = tick.isWaiting;
  isStarved_ = tick.isStarved;
  isAlong_ = tick.isCrowded || std::ranges::any_of(current_.near, [this](const TrackedScene::Near& entry) {
               return memory_[entry.body].isSearchLong;
             });
  if (isStarved_)
    forecast_.goAs(isAlong_ ? steadyHand_ : hand_);
  else if (isAlong_)
    forecast_.moveAs(steady_);
}

TrackedPair SceneTracker::pairOf(std::uint32_t index) const noexcept {
  const ServoScene::Body& body = current_.scene->bodies[index];
  return {body.geometry->tree(), current_.scene->moving.geometry->tree(), body.worldFromPart};
}

ListPurpose SceneTracker::forMinima(const SearchReach& reach) const noexcept {
  ListPurpose purpose{.cutoff = reach.cutoff, .planCutoff = reach.cutoff};
  // If minima are only shown, contacts must not wait for a long search.
  if (reach.contact > 0.0) purpose.part = purpose.least = purpose.whole;
  return purpose;
}

ListPurpose SceneTracker::forContacts(const SearchReach& reach) const noexcept {
  const CandidateList::Bounds along{ManyPairs::kMax, 1U << 18};
  const double cutoff = isAlong_ ? reachOfThousands(reach.contact) : reach.contact;
  const double turn = contactTurn(cutoff, current_.scene->metric.radius);
  // The proxy tries steps before it takes them, so there must be room for some, even around a part at rest.
  return {.cutoff = cutoff,
          .planCutoff = reach.widest(),
          .relaxation = turn,
          .leastRoom = {2.0 * reach.contact, 2.0 * turn},
          .isAlong = isAlong_,
          .whole = isAlong_ ? along : CandidateList::Bounds{1U << 15, 1U << 16},
          // A tick goes through a whole list several times.
          .part = isAlong_ ? along : CandidateList::Bounds{1U << 16, 1U << 18},
          .least = {1U << 17, 1U << 20},
          // A starved part gets a list around it; if there is already one, no other is better.
          .roomToKeep = isStarved_ ? 0.98 : 0.5};
}

bool SceneTracker::willServe(const TrackedScene::Near& entry, const SearchReach& reach) const noexcept {
  const TrackedPair pair = pairOf(entry.body);
  if (entry.list && !nearfit::willServe(*entry.list, pair, forecast_, forMinima(reach))) return false;
  if (entry.triangles) return willServe(*entry.triangles, entry.body, reach);
  if (entry.contacts) return nearfit::willServe(*entry.contacts, pair, forecast_, forContacts(reach));
  // There may have been too many pairs for the motion predicted then.
  return !(isStarved_ && (hasContacts(entry.body, reach) || hasTriangles(entry.body, reach)));
}

bool SceneTracker::willServe(const TriangleList& list, std::uint32_t body,
                             const SearchReach& reach) const noexcept {
  const double room = list.within() - reach.contact;
  const double keep = (isStarved_ ? kTriangleRoomIfStarved : kTriangleRoomToKeep) * room;
  const auto serves = [&](const RigidTransform& pose) {
    return list.reachAt(pairOf(body).queryAt(pose, reach.contact).sceneFromPart) - reach.contact >= keep;
  };
  return room > 0.0 && serves(forecast_.pose()) && serves(forecast_.poseWhenReady());
}

bool SceneTracker::hasContacts(std::uint32_t body, const SearchReach& reach) const noexcept {
  return reach.contact > 0.0 && !current_.scene->bodies[body].surface;
}

bool SceneTracker::hasTriangles(std::uint32_t body, const SearchReach& reach) const noexcept {
  return reach.contact > 0.0 && current_.scene->bodies[body].surface;
}

bool SceneTracker::isClearanceDue(const SearchReach& reach) const noexcept {
  const Clearance& known = current_.clearance;
  if (known.serial == 0) return true;
  const RigidTransform &then = known.worldFromPart, &now = forecast_.pose();
  const bool hasMoved = then.translation != now.translation || then.rotation != now.rotation;
  // Bodies that overlapped may have come apart.
  if (reach.contact <= 0.0) {
    return hasMoved && clearanceAge_ >= kTicksBetweenShownClearances &&
           (!known.overlapping->empty() || current_.clearanceSpent(now) > kShownClearanceToSpend);
  }
  return isWaiting_ ? hasMoved || known.distance > 0.0 : hasMoved && !known.overlapping->empty();
}

bool SceneTracker::isDue(const SearchReach& reach) const noexcept {
  if (!current_.scene || !current_.scene->moving.geometry) return false;
  if (isClearanceDue(reach)) return true;
  if (current_.reach != reach || !(current_.spent(forecast_.pose(), reach.widest()) <= 1.0) ||
      !(current_.spent(forecast_.poseWhenReady(), reach.widest()) <= 1.0)) {
    return true;
  }
  return std::any_of(current_.near.begin(), current_.near.end(),
                     [&](const TrackedScene::Near& entry) { return !willServe(entry, reach); });
}

void SceneTracker::refresh(const SearchReach& reach, TrackedScene& out) {
  const double cutoff = reach.widest();
  if (current_.scene->moving.geometry) {
    const SearchPlan plan = forecast_.plan(cutoff);
    const double radius = 0.5 * current_.scene->moving.geometry->mesh.bounds().diagonal();
    const std::vector<TrackedScene::Near> former = std::exchange(current_.near, {});
    current_.worldFromPart = plan.pose;
    current_.cutoff = 0.0;  // If memory runs out below, nothing is known.
    const auto wide =
        std::find_if(std::begin(kWideClearances), std::end(kWideClearances), [&](double factor) {
          current_.clear = clearance(factor, plan, radius);
          return isAllClear(cutoff, former);
        });
    if (wide == std::end(kWideClearances)) {
      current_.clear = clearance(kClearance, plan, radius);
      findNear(reach, former);
    }
    current_.cutoff = cutoff;
    current_.reach = reach;
    // With nothing near it costs little, and then holds as long as the room for motion found just now.
    const bool isAtHand = current_.near.empty() && current_.clearanceSpent(forecast_.pose()) > 0.0;
    if (isClearanceDue(reach) || (reach.contact <= 0.0 && isAtHand)) {
      current_.clearance =
          findClearance(*current_.scene, *current_.bounds, forecast_.pose(), reach.widest(), scratch_);
      current_.clearance.serial = ++lastSerial_;
      clearanceAge_ = 0.0;
    }
  }
  current_.serial = nextSerial();
  out = current_;
}

bool SceneTracker::isClearOf(std::uint32_t body, double cutoff) noexcept {
  // An unsided surface is near if its box is: minima do not tell.
  if (current_.scene->bodies[body].surface) return false;
  const BodyPairQuery query = pairOf(body).queryAt(current_.worldFromPart, cutoff);
  // The tick reports invalid poses.
  return query.sceneFromPart.isFinite() && isClearWithin(query, current_.clear, scratch_, kClearNodePairs);
}

bool SceneTracker::isAllClear(double cutoff, const std::vector<TrackedScene::Near>& former) noexcept {
  const auto isClear = [&](std::uint32_t body) { return isClearOf(body, cutoff); };
  // Former near bodies most likely still are; ask them before the thousands that so wide a sphere may hold.
  if (!std::all_of(former.begin(), former.end(), [&](const auto& entry) { return isClear(entry.body); }))
    return false;
  const MovingBounds moving = movingBounds(*current_.scene, current_.worldFromPart);
  return current_.bounds->isEachNear(moving.centre, moving.radius + cutoff + current_.clear.travel, isClear);
}

void SceneTracker::findNear(const SearchReach& reach, const std::vector<TrackedScene::Near>& former) {
  const MovingBounds moving = movingBounds(*current_.scene, current_.worldFromPart);
  const double cutoff = reach.widest();
  current_.bounds->visitNear(moving.centre, moving.radius + cutoff + current_.clear.travel,
                             [&](std::uint32_t body) { current_.near.push_back({.body = body}); });
  std::sort(current_.near.begin(), current_.near.end(), isBefore);
  for (BodyPreparer& of : preparers_) {
    const auto isNear = [&](const TrackedScene::Near& entry) { return of.body == entry.body; };
    if (std::ranges::none_of(current_.near, isNear)) of.body.reset();
  }
  std::erase_if(current_.near, [&](TrackedScene::Near& entry) {
    TrackedScene::Near old{};
    const auto found = std::lower_bound(former.begin(), former.end(), entry, isBefore);
    if (found != former.end() && found->body == entry.body) old = *found;
    const bool wasListed = old.list && willServe({.body = entry.body, .list = old.list}, reach);
    if (!wasListed && isClearOf(entry.body, cutoff)) return true;
    // With springs a tick needs all minima: making a list is worth any attempt.
    Memory& memory = memory_[entry.body];
    if (!(reach.contact > 0.0)) memory = {};
    entry.list = renewed(old.list, entry.body, forMinima(reach), memory.minima);
    if (hasContacts(entry.body, reach)) renewContacts(entry, old, reach);
    if (hasTriangles(entry.body, reach))
      entry.triangles = renewedTriangles(old.triangles, entry.body, reach, memory.triangles);
    return false;
  });
}

double SceneTracker::ticksTo(double share, const CandidateList& list, std::uint32_t body) const noexcept {
  constexpr double kBetween = 2.0, kMinRate = 1e-3;
  const auto timeIn = [&](double ticks) {
    return list.timeAt(pairOf(body).queryAt(forecast_.poseIn(ticks), list.cutoff()).sceneFromPart);
  };
  const double time = timeIn(1.0), rate = (timeIn(1.0 + kBetween) - time) / kBetween;
  if (!(std::abs(time) < 1.0) || !(std::abs(rate) > kMinRate)) return 1.0;
  return std::max(1.0, 1.0 + ((rate > 0.0 ? share : -share) - time) / rate);
}

void SceneTracker::renewContacts(TrackedScene::Near& entry, const TrackedScene::Near& old,
                                 const SearchReach& reach) {
  Memory& memory = memory_[entry.body];
  ListPurpose purpose = forContacts(reach);
  // A part that does not wait goes on with the former list to its end.
  const CandidateList* const former = isAlong_ && !isStarved_ ? old.contacts.get() : nullptr;
  if (former != nullptr)
    purpose.begin = std::clamp(ticksTo(1.0, *former, entry.body) - kOverlap, 0.0, forecast_.lead());
  entry.contacts = renewed(old.contacts, entry.body, purpose, isAlong_ ? memory.along : memory.contacts);
  if (entry.contacts && entry.contacts == old.contacts) {
    entry.prepared = old.prepared;
    entry.formerPrepared = old.formerPrepared;
    return;
  }
  memory.isSearchLong = !entry.contacts || entry.contacts->searchWork() > kLongSearch;
  const RigidTransform claimed = former != nullptr && old.prepared
                                     ? forecast_.poseIn(ticksTo(kShareAtClaim, *former, entry.body))
                                     : forecast_.poseWhenReady();
  entry.prepared = prepared(entry.body, entry.contacts.get(), claimed, reach);
  entry.formerPrepared = old.prepared;
}

std::shared_ptr<const CandidateList> SceneTracker::renewed(const std::shared_ptr<const CandidateList>& former,
                                                           std::uint32_t body, const ListPurpose& purpose,
                                                           PlanMemory& memory) {
  if (former && nearfit::willServe(*former, pairOf(body), forecast_, purpose)) return former;
  const std::shared_ptr<CandidateList> list = spareOf(lists_);
  return buildForPlan(*list, pairOf(body), forecast_, purpose, scratch_, memory) ? list : nullptr;
}

PairPreparer* SceneTracker::preparerOf(std::uint32_t body) {
  auto of = std::ranges::find(preparers_, std::optional(body), &BodyPreparer::body);
  if (of != preparers_.end()) return of->preparer.get();
  of = std::ranges::find(preparers_, std::optional<std::uint32_t>(), &BodyPreparer::body);
  if (of == preparers_.end()) {
    if (preparers_.size() == kMaxPrepared) return nullptr;
    of = preparers_.insert(of, BodyPreparer{std::nullopt, std::make_unique<PairPreparer>()});
  }
  of->body = body;
  of->preparer->forget();
  return of->preparer.get();
}

std::shared_ptr<PreparedPairs> SceneTracker::prepared(std::uint32_t body, const CandidateList* list,
                                                      const RigidTransform& claimed,
                                                      const SearchReach& reach) {
  if (list == nullptr || !(list->cutoff() < reach.contact) || list->size() < ManyPairs::kFew ||
      list->size() > ManyPairs::kMax)
    return nullptr;
  PairPreparer* const preparer = preparerOf(body);
  if (preparer == nullptr) return nullptr;
  const std::shared_ptr<PreparedPairs> out = spareOf(preparedPairs_);
  preparer->prepare(*current_.scene, current_.scene->bodies[body], *list,
                    pairOf(body).queryAt(claimed, reach.contact).sceneFromPart, reach.contact, nextSerial(),
                    *out);
  return out;
}

std::shared_ptr<const TriangleList> SceneTracker::renewedTriangles(
    const std::shared_ptr<const TriangleList>& former, std::uint32_t body, const SearchReach& reach,
    double& share) {
  if (former && willServe(*former, body, reach)) return former;
  const SearchPlan plan = forecast_.plan(reach.contact);
  const MotionRange& range = plan.range;
  const double radius = 0.5 * current_.scene->moving.geometry->mesh.bounds().diagonal();
  const double way =
      range.budget.travel + glm::length(range.stretch.shift) + radius * glm::length(range.stretch.spin);
  const double room = std::max(way, kUsualTriangleRoom * reach.contact);
  const double least = kLeastTriangleRoom * reach.contact;
  const std::shared_ptr<TriangleList> list = spareOf(triangleLists_);
  // What was too much most likely still is; what was enough may leave more room.
  share = std::min(1.0, 2.0 * share);
  const ServoScene& scene = *current_.scene;
  for (;; share *= 0.5) {
    const double within = reach.contact + std::max(least, share * room);
    list->build(*scene.bodies[body].surface, *scene.moving.surface,
                pairOf(body).queryAt(plan.pose, within).sceneFromPart, within, scratch_,
                isStarved_ ? kMaxListedIfStarved : kMaxListedTriangles,
                isStarved_ ? kMaxListingWorkIfStarved : kMaxListingWork);
    if (list->within() >= reach.contact + least) return list;
    if (share * room <= least) return nullptr;
  }
}

}  // namespace nearfit
