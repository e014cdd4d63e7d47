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

/// Where a SolidMove has brought its parts.
struct SolidReached {
  std::uint64_t wanted = 0;           ///< Which want() they were on the way to.
  std::vector<RigidTransform> poses;  ///< worldFromPart, in the order of the parts.
  RigidTransform motion;              ///< From the start to there.
  std::vector<PartId> touching;
  bool isSettled = false;   ///< They go no farther.
  bool hasArrived = false;  ///< Where they were wanted, to the last bit.
};

/// A SolidMove in a thread of its own: whoever drags never waits for it, and sees the newest that it has
/// reached. What has to be prepared before is prepared there too.
class SolidRunner : public QObject {
  Q_OBJECT

 public:
  explicit SolidRunner(QObject* parent = nullptr);
  /// Stops the thread; waits for no more than a few ticks.
  ~SolidRunner() override;

  /// Begins with parts where the scene has them; whatever was under way is forgotten.
  void start(Scene scene, std::vector<PartId> moved);
  /// Where they are to go from now on. @param motion  As for SolidMove::advance.
  /// @return What SolidReached::wanted will be.
  std::uint64_t want(const RigidTransform& motion);
  void stop();

 signals:
  /// On this object's thread, for the newest only.
  void reached(const nearfit::ui::SolidReached& reached);
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
  /// Waits until something is wanted that is not `done`; nothing once the job is not the present one.
  std::optional<Wanted> nextWanted(std::uint64_t job, std::uint64_t done);
  bool isPresent(std::uint64_t job);
  void publish(std::uint64_t job, SolidReached reached);
  void publishFailure(std::uint64_t job, const std::exception_ptr& error);
  void deliver();

  std::mutex mutex_;  ///< Guards all that follows but the thread.
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
