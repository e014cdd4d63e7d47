#pragma once

#include <QObject>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/placing/solid_move.h"

namespace nearfit::ui {

/// Poses that a SolidMove has reached.
struct SolidReached {
  std::uint64_t wanted = 0;           ///< The want() they were moving towards.
  std::vector<RigidTransform> poses;  ///< worldFromPart, in the order of the parts.
  RigidTransform motion;              ///< World motion from the start to these poses.
  std::vector<PartId> touching;
  bool isSettled = false;   ///< They go no farther.
  bool hasArrived = false;  ///< They are exactly where they were wanted.
};

/// Runs a SolidMove in its own thread, so that a drag never waits for it, and reports the newest poses.
/// Missing hierarchies are built in that thread too.
class SolidRunner : public QObject {
  Q_OBJECT

 public:
  explicit SolidRunner(QObject* parent = nullptr);
  /// Stops and joins the thread; takes a few ticks at most.
  ~SolidRunner() override;

  /// Starts a move with the parts at their poses in `scene`; drops any other move.
  void start(Scene scene, std::vector<PartId> moved);
  /// Sets where the parts are to go.
  /// @param motion  As for SolidMove::advance.
  /// @return  The value of SolidReached::wanted that will refer to this call.
  std::uint64_t want(const RigidTransform& motion);
  /// Ends the move; its results are no longer reported.
  void stop();

 signals:
  /// Emitted on this object's thread with the newest poses; older ones may be skipped.
  void reached(const nearfit::ui::SolidReached& reached);
  /// Emitted on this object's thread when the move has failed.
  void failed(const std::exception_ptr& error);

 private:
  struct Job {
    std::uint64_t serial = 0;
    Scene scene;
    std::vector<PartId> moved;
  };
  struct Wanted {
    std::uint64_t serial = 0;
    RigidTransform motion;
  };

  void work();
  void runJob(const Job& job);
  std::optional<Job> nextJob();
  /// Waits for a want() newer than `done`; nullopt once `job` is no longer the current one.
  std::optional<Wanted> nextWanted(std::uint64_t job, std::uint64_t done);
  bool isPresent(std::uint64_t job);
  void publish(std::uint64_t job, SolidReached reached);
  void publishFailure(std::uint64_t job, const std::exception_ptr& error);
  void deliver();

  std::mutex mutex_;  ///< Guards all members below except thread_.
  std::condition_variable changed_;
  Job job_;
  Wanted wanted_;
  std::uint64_t begun_ = 0, lastSerial_ = 0;
  std::optional<SolidReached> newest_;
  std::exception_ptr error_;
  bool isDelivering_ = false, isEnding_ = false;
  std::thread thread_;
};

}  // namespace nearfit::ui
