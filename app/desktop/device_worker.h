#pragma once

#include <QObject>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "core/base/progress.h"

namespace nearfit::desktop {

/// Runs jobs that may have to wait for devices one after the other, on its own thread, so that the
/// window never waits.
class DeviceWorker : public QObject {
  Q_OBJECT

 public:
  using Job = std::function<void(const ProgressCallback&)>;
  struct Listener {
    std::function<void(std::exception_ptr)> onDone;  ///< Receives what the job threw, or null.
    std::function<void(double)> onProgress;          ///< Receives the fraction done; may be empty.
  };

  /// A job that was submitted. For the thread that owns the worker only.
  class Ticket {
   public:
    /// Asks the job to end and drops its listener; does not wait.
    void cancel() noexcept { isCancelled_.store(true, std::memory_order_relaxed); }
    bool isCancelled() const noexcept { return isCancelled_.load(std::memory_order_relaxed); }

   private:
    std::atomic<bool> isCancelled_{false};
  };

  DeviceWorker();
  /// Cancels all jobs, still runs those that wait, and joins the thread.
  ~DeviceWorker() override;

  /// Submits a job.
  /// @param job       Runs on the worker's thread, even if it was cancelled before; may throw.
  /// @param listener  Called on this object's thread.
  std::shared_ptr<Ticket> run(Job job, Listener listener);

 private:
  struct Task {
    Job job;
    Listener listener;
    std::shared_ptr<Ticket> ticket;
  };

  void serve();
  void perform(const std::shared_ptr<Task>& task);
  void tell(const std::shared_ptr<Task>& task, double fraction);

  std::mutex mutex_;
  std::condition_variable hasTask_;
  std::deque<std::shared_ptr<Task>> tasks_;
  std::shared_ptr<Task> current_;
  bool isEnding_ = false;
  std::thread thread_;
};

}  // namespace nearfit::desktop
