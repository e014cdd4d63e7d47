#pragma once

#include <QObject>
#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <thread>

#include "core/mesh/mesh_import.h"

namespace nearfit::ui {

/// Runs one long job at a time in a thread of its own and reports back on this object's thread.
class BackgroundTask : public QObject {
  Q_OBJECT

 public:
  using Job = std::function<void(const ProgressCallback&)>;

  explicit BackgroundTask(QObject* parent = nullptr);
  /// Cancels and waits.
  ~BackgroundTask() override;

  bool isRunning() const noexcept { return isRunning_; }
  /// @param job  Runs in the other thread; may throw.
  /// @param done Runs on this object's thread after the job ended; gets what it threw, or null.
  /// Nothing may be running.
  void run(Job job, std::function<void(std::exception_ptr)> done);

 public slots:
  /// Asks the job to stop; it then throws Cancelled at its next report of progress.
  void cancel() noexcept { isCancelled_.store(true, std::memory_order_relaxed); }

 signals:
  /// 0 to 1; at most some fifty times a job.
  void progressed(double fraction);

 private:
  void finish(const std::exception_ptr& error);

  std::thread thread_;
  std::atomic<bool> isCancelled_{false};
  bool isRunning_ = false;
  std::function<void(std::exception_ptr)> done_;
};

}  // namespace nearfit::ui
