#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>

#include "core/realtime/latency_histogram.h"
#include "core/realtime/triple_buffer.h"
#include "core/servo/scene_tracker.h"

namespace nearfit {

/// Searches the scene ahead of the motion, in its own thread: takes scenes from the controlling thread and
/// poses from the servo thread, and passes the newest TrackedScene to the servo thread.
class SceneRefresher {
 public:
  /// Searches once, so that the first TrackedScene is ready; starts no thread.
  SceneRefresher(std::shared_ptr<const ServoScene> scene, const SearchReach& reach);
  ~SceneRefresher() { stop(); }
  SceneRefresher(const SceneRefresher&) = delete;
  SceneRefresher& operator=(const SceneRefresher&) = delete;

  /// Throws std::system_error if no thread can be started.
  void start();
  /// Joins the thread; no-op while stopped.
  void stop() noexcept;

  /// Controlling thread: replaces the scene; the servo gets it as soon as it is searched.
  void setScene(std::shared_ptr<const ServoScene> scene);

  /// Servo thread; real-time safe: returns the newest TrackedScene, unchanged until the next call.
  const TrackedScene& latest() noexcept {
    tracked_.update();
    return tracked_.front();
  }
  /// State of the servo after a tick.
  struct Report {
    TickObservation observation{};
    SearchReach reach;       ///< How far to search.
    std::uint64_t tick = 0;  ///< Number of the tick, from 1; ascending.
  };
  /// Servo thread; real-time safe.
  void report(const Report& report) noexcept { reports_.publish(report); }

  /// Controlling thread: durations of all searches so far.
  const LatencyHistogram& refreshTimes() noexcept {
    times_.update();
    return times_.front();
  }

 private:
  void run() noexcept;
  std::shared_ptr<const ServoScene> pendingScene();
  /// Drops the pending scene, unless a newer one replaced it.
  void forgetPending(const ServoScene& scene);
  bool takeReport() noexcept;
  void refresh();

  SceneTracker tracker_;
  TripleBuffer<TrackedScene> tracked_;
  TripleBuffer<Report> reports_;
  TripleBuffer<LatencyHistogram> times_;
  LatencyHistogram refreshTimes_;
  SearchReach reach_;
  std::uint64_t lastTick_ = 0;
  std::uint64_t renewAfter_ = 0;  ///< The servo lets go of a former scene after this tick; 0 for none.

  std::mutex pendingMutex_;
  std::shared_ptr<const ServoScene> pending_;  ///< Waits to be searched.
  std::atomic<bool> stopRequested_{false};
  std::thread thread_;
};

}  // namespace nearfit
