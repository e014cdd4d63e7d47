#include "device/servo/scene_refresher.h"

#include <chrono>
#include <cmath>
#include <utility>

namespace nearfit {
namespace {

/// A quarter of a tick, so that no pose is seen late.
constexpr auto kPollPeriod = std::chrono::microseconds(250);
/// Ticks from a pose until its search begins: this thread sleeps, and may wait for a processor.
constexpr double kWakeUp = 0.5;
constexpr double kTick = 1e-3;  ///< Servo period [s].
/// Pause after a failure (out of memory); meanwhile ticks search for themselves.
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
        // Not earlier, so that a scene is retried if memory ran out.
        if (next) forgetPending(*next);
        // The servo may still show the former scene in the next tick; the one after that uses the new one.
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
    tracker_.update(report.observation, static_cast<double>(report.tick - lastTick_));
    lastTick_ = report.tick;
  }
  // Non-finite settings are for the tick to refuse.
  if (std::isfinite(report.reach.cutoff) && std::isfinite(report.reach.contact)) reach_ = report.reach;
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
  // It may hold the last reference to a former scene's meshes.
  tracked_.back() = TrackedScene{};
}

}  // namespace nearfit
