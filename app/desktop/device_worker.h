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

#include "core/progress.h"

namespace nearfit::desktop {

/// What is to be done with devices and may have to wait for them, in a thread of its own, one after the
/// other: the window never waits.
class DeviceWorker : public QObject {
  Q_OBJECT

 public:
  using Job = std::function<void(const ProgressCallback&)>;
  struct Listener {
    std::function<void(std::exception_ptr)> onDone;  ///< With what the job threw, or null.
    std::function<void(double)> onProgress;          ///< May be empty.
  };

  /// A job that was given. Only the worker's owner's thread uses it.
  class Ticket {
   public:
    /// Nobody listens to the job any more, and it is asked to end; the call does not wait.
    void cancel() noexcept { isCancelled_.store(true, std::memory_order_relaxed); }
    bool isCancelled() const noexcept { return isCancelled_.load(std::memory_order_relaxed); }

   private:
    std::atomic<bool> isCancelled_{false};
  };

  DeviceWorker();
  /// Cancels what opens, does what was given, and waits for it.
  ~DeviceWorker() override;

  /// @param job       Runs in the other thread, even when it has been cancelled before; may throw.
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
