#include "device/servo/scene_refresher.h"

#include <chrono>
#include <cmath>
#include <utility>

namespace nearfit {
namespace {

/// Between two looks at the pose: a quarter of a tick, so that nothing is seen late.
constexpr auto kPollPeriod = std::chrono::microseconds(250);
/// Ticks from a pose until a search for it begins: this thread sleeps, and may have to wait for a processor.
constexpr double kWakeUp = 0.5;
constexpr double kTick = 1e-3;  ///< Of the servo [s].
/// After a failure (memory ran out): ticks search for themselves meanwhile.
constexpr auto kRetryPeriod = std::chrono::milliseconds(100);

}  // namespace

SceneRefresher::SceneRefresher(std::shared_ptr<const ServoScene> scene, const SearchReach& reach)
    : reach_(reach) {
  tracker_.setScene(std::move(scene));
  refresh();
}

void SceneRefresher::start() {
  stopRequested_.store(false);
  thread_ = std::thread([this] { run(); });
}

void SceneRefresher::stop() noexcept {
  stopRequested_.store(true);
  if (thread_.joinable()) thread_.join();
}

void SceneRefresher::setScene(std::shared_ptr<const ServoScene> scene) {
  const std::lock_guard lock(pendingMutex_);
  pending_ = std::move(scene);
}

void SceneRefresher::run() noexcept {
  while (!stopRequested_.load(std::memory_order_relaxed)) {
    try {
      const bool hasMoved = takeReport();
      const std::shared_ptr<const ServoScene> next = pendingScene();
      if (next) tracker_.setScene(next);
      const bool isToRenew = renewAfter_ != 0 && lastTick_ > renewAfter_;
      if (next || isToRenew || (hasMoved && tracker_.isDue(reach_))) {
        refresh();
        // Not before, so that where memory ran out it is taken up again.
        if (next) forgetPending(*next);
        // The servo may still show the former scene in the next tick; the one after that is with this one.
        renewAfter_ = next ? lastTick_ + 2 : isToRenew ? 0 : renewAfter_;
      } else {
        std::this_thread::sleep_for(kPollPeriod);
      }
    } catch (...) {
      std::this_thread::sleep_for(kRetryPeriod);
    }
  }
}

bool SceneRefresher::takeReport() noexcept {
  if (!reports_.update()) return false;
  const Report& report = reports_.front();
  if (report.tick > lastTick_) {
    const auto ticks = static_cast<double>(report.tick - lastTick_);
    tracker_.observe(report.worldFromPart, ticks);
    tracker_.observeHand(report.worldFromHand, ticks);
    lastTick_ = report.tick;
  }
  // Settings that are no numbers are for the tick to refuse.
  if (std::isfinite(report.reach.cutoff) && std::isfinite(report.reach.contact)) reach_ = report.reach;
  tracker_.setWaiting(report.isWaiting);
  tracker_.setStarved(report.isStarved);
  return true;
}

std::shared_ptr<const ServoScene> SceneRefresher::pendingScene() {
  const std::lock_guard lock(pendingMutex_);
  return pending_;
}

void SceneRefresher::forgetPending(const ServoScene& scene) {
  const std::lock_guard lock(pendingMutex_);
  if (pending_.get() == &scene) pending_.reset();
}

void SceneRefresher::refresh() {
  using Seconds = std::chrono::duration<double>;
  const auto start = std::chrono::steady_clock::now();
  tracker_.refresh(reach_, tracked_.back());
  tracked_.publish();
  const double time = Seconds(std::chrono::steady_clock::now() - start).count();
  tracker_.setLead(kWakeUp + time / kTick);
  refreshTimes_.record(time);
  times_.publish(refreshTimes_);
  // What it held may be the last that keeps a former scene's meshes.
  tracked_.back() = TrackedScene{};
}

}  // namespace nearfit
