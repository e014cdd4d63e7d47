#include "ui/background_task.h"

#include <QMetaObject>
#include <utility>

namespace nearfit::ui {

BackgroundTask::BackgroundTask(QObject* parent) : QObject(parent) {}

BackgroundTask::~BackgroundTask() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

void BackgroundTask::run(Job job, std::function<void(std::exception_ptr)> done) {
  Q_ASSERT(!isRunning_);
  isRunning_ = true;
  isCancelled_ = false;
  done_ = std::move(done);
  thread_ = std::thread([this, job = std::move(job)] {
    constexpr double kStep = 0.02;
    double reported = 0.0;
    const ProgressCallback progress = [this, &reported](double fraction) {
      if (fraction >= reported + kStep) {
        reported = fraction;
        QMetaObject::invokeMethod(
            this, [this, fraction] { emit progressed(fraction); }, Qt::QueuedConnection);
      }
      return !isCancelled_.load(std::memory_order_relaxed);
    };
    std::exception_ptr error;
    try {
      job(progress);
    } catch (...) {
      error = std::current_exception();
    }
    QMetaObject::invokeMethod(
        this, [this, error] { finish(error); }, Qt::QueuedConnection);
  });
}

void BackgroundTask::finish(const std::exception_ptr& error) {
  thread_.join();
  isRunning_ = false;
  // The callback may start the next job.
  const auto done = std::exchange(done_, nullptr);
  done(error);
}

}  // namespace nearfit::ui
