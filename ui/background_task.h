#pragma once

#include <QObject>
#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "core/mesh/mesh_import.h"

namespace nearfit::ui {

/// Runs one long job at a time in a thread of its own and reports back on this object's thread.
class BackgroundTask : public QObject {
  Q_OBJECT

 public:
  using Job = std::function<void(const ProgressCallback&)>;

  explicit BackgroundTask(QObject* parent = nullptr);
  /// Cancels and waits, also for jobs that were cancelled before.
  ~BackgroundTask() override;

  bool isRunning() const noexcept { return current_ != nullptr; }
  /// @param job  Runs in the other thread; may throw. It owns what it uses: once cancelled it may go on for
  ///             a while when its end has been told, and beside the next job.
  /// @param done Runs on this object's thread after the job ended; gets what it threw, or null.
  /// Nothing may be running.
  void run(Job job, std::function<void(std::exception_ptr)> done);

 public slots:
  /// Asks the job to stop, and tells its end, with Cancelled, without waiting until it looks: that may take
  /// it a second.
  void cancel();

 signals:
  /// 0 to 1; at most some fifty times a job.
  void progressed(double fraction);

 private:
  struct Running {
    std::atomic<bool> isCancelled{false};
    std::function<void(std::exception_ptr)> done;
    std::thread thread;
  };
  using RunningPtr = std::shared_ptr<Running>;
  void work(Running& running, const Job& job);
  void finish(const Running* running, const std::exception_ptr& error);

  RunningPtr current_;
  std::vector<RunningPtr> abandoned_;  ///< Cancelled; each ends when it next reports progress.
};

}  // namespace nearfit::ui
