#include "ui/widgets/background_task.h"

#include <QMetaObject>
#include <algorithm>
#include <utility>

#include "core/base/error.h"

namespace nearfit::ui {

BackgroundTask::BackgroundTask(QObject* parent) : QObject(parent) {}

BackgroundTask::~BackgroundTask() {
  if (current_) abandoned_.push_back(std::move(current_));
  for (const RunningPtr& running : abandoned_)
    running->isCancelled = true;
  for (const RunningPtr& running : abandoned_)
    running->thread.join();
}

void BackgroundTask::run(Job job, std::function<void(std::exception_ptr)> done) {
  Q_ASSERT(!isRunning());
  current_ = std::make_shared<Running>();
  current_->done = std::move(done);
  // A raw pointer is safe: the thread is joined before its Running is destroyed.
  current_->thread =
      std::thread([this, running = current_.get(), job = std::move(job)] { work(*running, job); });
}

void BackgroundTask::work(Running& running, const Job& job) {
  constexpr double kStep = 0.02;
  double reported = 0.0;
  const Running* own = &running;
  const ProgressCallback progress = [this, &running, own, &reported](double fraction) {
    if (running.isCancelled.load(std::memory_order_relaxed)) return false;
    if (fraction >= reported + kStep) {
      reported = fraction;
      QMetaObject::invokeMethod(
          this,
          [this, own, fraction] {
            if (current_.get() == own) emit progressed(fraction);
          },
          Qt::QueuedConnection);
    }
    return true;
  };
  std::exception_ptr error;
  try {
    job(progress);
  } catch (...) {
    error = std::current_exception();
  }
  QMetaObject::invokeMethod(this, [this, own, error] { finish(own, error); }, Qt::QueuedConnection);
}

void BackgroundTask::cancel() {
  if (!current_ || current_->isCancelled.exchange(true)) return;
  QMetaObject::invokeMethod(
      this,
      // Holding a reference keeps a later job from getting the same address.
      [this, own = current_] {
        if (current_ != own) return;
        const RunningPtr running = abandoned_.emplace_back(std::move(current_));
        running->done(std::make_exception_ptr(Cancelled()));
      },
      Qt::QueuedConnection);
}

void BackgroundTask::finish(const Running* running, const std::exception_ptr& error) {
  if (current_.get() == running) {
    // The callback may start the next job.
    const RunningPtr ended = std::move(current_);
    ended->thread.join();
    ended->done(error);
    return;
  }
  const auto it = std::ranges::find(abandoned_, running, &RunningPtr::get);
  if (it == abandoned_.end()) return;
  (*it)->thread.join();
  abandoned_.erase(it);
}

}  // namespace nearfit::ui
