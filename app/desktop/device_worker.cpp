#include "app/desktop/device_worker.h"

#include <QMetaObject>
#include <utility>

namespace nearfit::desktop {

DeviceWorker::DeviceWorker() : thread_([this] { serve(); }) {}

DeviceWorker::~DeviceWorker() {
  {
    const std::lock_guard lock(mutex_);
    isEnding_ = true;
    for (const std::shared_ptr<Task>& each : tasks_)
      each->ticket->cancel();
    if (current_) current_->ticket->cancel();
  }
  hasTask_.notify_one();
  thread_.join();
}

std::shared_ptr<DeviceWorker::Ticket> DeviceWorker::run(Job job, Listener listener) {
  auto ticket = std::make_shared<Ticket>();
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::make_shared<Task>(Task{std::move(job), std::move(listener), ticket}));
  }
  hasTask_.notify_one();
  return ticket;
}

void DeviceWorker::serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    hasTask_.wait(lock, [this] { return isEnding_ || !tasks_.empty(); });
    if (tasks_.empty()) return;
    current_ = std::move(tasks_.front());
    tasks_.pop_front();
    const std::shared_ptr<Task> task = current_;
    lock.unlock();
    perform(task);
    lock.lock();
    current_.reset();
  }
}

void DeviceWorker::perform(const std::shared_ptr<Task>& task) {
  constexpr double kStep = 0.02;
  double told = 0.0;
  const ProgressCallback progress = [&](double fraction) {
    if (fraction >= told + kStep) tell(task, told = fraction);
    return !task->ticket->isCancelled();
  };
  std::exception_ptr error;
  try {
    task->job(progress);
  } catch (...) {
    error = std::current_exception();
  }
  // Release here what the job holds: it may be the last reference to a device.
  task->job = nullptr;
  QMetaObject::invokeMethod(
      this,
      [task, error] {
        if (!task->ticket->isCancelled() && task->listener.onDone) task->listener.onDone(error);
      },
      Qt::QueuedConnection);
}

void DeviceWorker::tell(const std::shared_ptr<Task>& task, double fraction) {
  QMetaObject::invokeMethod(
      this,
      [task, fraction] {
        if (!task->ticket->isCancelled() && task->listener.onProgress) task->listener.onProgress(fraction);
      },
      Qt::QueuedConnection);
}

}  // namespace nearfit::desktop
