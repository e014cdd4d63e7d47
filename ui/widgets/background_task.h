#pragma once

#include <QObject>
#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "core/import/mesh_import.h"

namespace nearfit::ui {

/// Runs one job at a time in a worker thread and reports back on this object's thread.
class BackgroundTask : public QObject {
  Q_OBJECT

 public:
  using Job = std::function<void(const ProgressCallback&)>;

  explicit BackgroundTask(QObject* parent = nullptr);
  /// Cancels and joins all jobs, including ones cancelled earlier. Calls no `done`.
  ~BackgroundTask() override;

  /// True from run() until just before `done` is called.
  bool isRunning() const noexcept { return current_ != nullptr; }
  /// Starts a job. None may be running.
  /// @param job   Runs in the worker thread; may throw. Must own what it uses: after cancel() it may still
  ///              run for a while, even beside the next job.
  /// @param done  Called on this object's thread when the job ends, with what it threw or null.
  void run(Job job, std::function<void(std::exception_ptr)> done);

 public slots:
  /// Asks the job to stop and soon calls its `done` with Cancelled, from the event loop. Does not wait until
  /// the job notices, which may take a second.
  void cancel();

 signals:
  /// Emitted at most about 50 times per job. `fraction` goes from 0 to 1.
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
  std::vector<RunningPtr> abandoned_;  ///< Cancelled jobs; each ends when it next reports progress.
};

}  // namespace nearfit::ui
