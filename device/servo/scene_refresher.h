#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>

#include "core/haptics/scene_tracker.h"
#include "core/realtime/latency_histogram.h"
#include "core/realtime/triple_buffer.h"

namespace nearfit {

/// Keeps what the servo thread knows of the scene ahead of the motion, in a thread of its own: scenes come
/// from the controlling thread, poses from the servo thread, and the newest TrackedScene goes to it.
class SceneRefresher {
 public:
  /// The first TrackedScene is there when this returns. Not running yet.
  SceneRefresher(std::shared_ptr<const ServoScene> scene, const SearchReach& reach);
  ~SceneRefresher() { stop(); }
  SceneRefresher(const SceneRefresher&) = delete;
  SceneRefresher& operator=(const SceneRefresher&) = delete;

  /// Throws std::system_error when no thread is to be had.
  void start();
  void stop() noexcept;

  /// Another scene for the servo, as soon as it is searched. Controlling thread.
  void setScene(std::shared_ptr<const ServoScene> scene);

  /// The newest; stays as it is until the next call. Servo thread; real-time safe.
  const TrackedScene& latest() noexcept {
    tracked_.update();
    return tracked_.front();
  }
  struct Report {
    RigidTransform worldFromPart;  ///< Where the part is.
    RigidTransform worldFromHand;  ///< Where the hand would have it.
    SearchReach reach;             ///< How far is looked.
    std::uint64_t tick = 0;
    bool isWaiting = false;  ///< The proxy stands until it is known what it overlaps there.
    bool isStarved = false;  ///< Lists of contacts do not reach where it would go.
  };
  /// Servo thread; real-time safe.
  void report(const Report& report) noexcept { reports_.publish(report); }

  /// How long searches took, as of the last one. Controlling thread.
  const LatencyHistogram& refreshTimes() noexcept {
    times_.update();
    return times_.front();
  }

 private:
  void run() noexcept;
  std::shared_ptr<const ServoScene> pendingScene();
  /// Unless there is a newer one.
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
  std::uint64_t renewAfter_ = 0;  ///< Tick after which the servo has let go of a former scene; 0 for none.

  std::mutex pendingMutex_;
  std::shared_ptr<const ServoScene> pending_;  ///< Until the servo can have it.
  std::atomic<bool> stopRequested_{false};
  std::thread thread_;
};

}  // namespace nearfit
