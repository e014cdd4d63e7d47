#include "ui/tools/placing/solid_runner.h"

#include <QMetaObject>
#include <utility>

#include "core/base/error.h"

namespace nearfit::ui {
namespace {

/// Ticks between checks for a newer want(): few enough to follow a drag at once.
constexpr int kTicksAtOnce = 6;

}  // namespace

SolidRunner::SolidRunner(QObject* parent) : QObject(parent), thread_([this] { work(); }) {}

SolidRunner::~SolidRunner() {
  {
    const std::lock_guard lock(mutex_);
    isEnding_ = true;
    job_.serial = 0;
  }
  changed_.notify_all();
  thread_.join();
}

void SolidRunner::start(Scene scene, std::vector<PartId> moved) {
  {
    const std::lock_guard lock(mutex_);
    job_ = {++lastSerial_, std::move(scene), std::move(moved)};
    wanted_ = {};
    newest_.reset();
    error_ = nullptr;
  }
  changed_.notify_all();
}

std::uint64_t SolidRunner::want(const RigidTransform& motion) {
  std::uint64_t serial = 0;
  {
    const std::lock_guard lock(mutex_);
    serial = ++lastSerial_;
    wanted_ = {serial, motion};
  }
  changed_.notify_all();
  return serial;
}

void SolidRunner::stop() {
  {
    const std::lock_guard lock(mutex_);
    job_.serial = 0;
    newest_.reset();
    error_ = nullptr;
  }
  changed_.notify_all();
}

bool SolidRunner::isPresent(std::uint64_t job) {
  const std::lock_guard lock(mutex_);
  return job_.serial == job;
}

std::optional<SolidRunner::Job> SolidRunner::nextJob() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return isEnding_ || (job_.serial != 0 && job_.serial != begun_); });
  if (isEnding_) return std::nullopt;
  begun_ = job_.serial;
  return job_;
}

std::optional<SolidRunner::Wanted> SolidRunner::nextWanted(std::uint64_t job, std::uint64_t done) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return job_.serial != job || wanted_.serial > done; });
  if (job_.serial != job) return std::nullopt;
  return wanted_;
}

void SolidRunner::work() {
  while (const std::optional<Job> job = nextJob()) {
    try {
      runJob(*job);
    } catch (const Cancelled&) {
      // Another move or a stop has ended it.
    } catch (...) {
      publishFailure(job->serial, std::current_exception());
    }
  }
}

void SolidRunner::runJob(const Job& job) {
  SolidMove move(job.scene, job.moved, [&](double) { return isPresent(job.serial); });
  std::uint64_t done = 0, underWay = 0;
  int ticks = 0;
  while (const std::optional<Wanted> wanted = nextWanted(job.serial, done)) {
    if (wanted->serial != underWay) ticks = 0;
    underWay = wanted->serial;
    ticks += kTicksAtOnce;
    const SolidMove::Progress progress = move.advance(wanted->motion, kTicksAtOnce);
    const bool isSettled = progress.isSettled || ticks >= SolidMove::kMaxTicks;
    if (isSettled) done = wanted->serial;
    publish(job.serial,
            {wanted->serial, move.poses(), move.motion(), move.touching(), isSettled, progress.hasArrived});
  }
}

void SolidRunner::publish(std::uint64_t job, SolidReached reached) {
  const std::lock_guard lock(mutex_);
  if (job_.serial != job) return;
  newest_ = std::move(reached);
  if (std::exchange(isDelivering_, true)) return;
  QMetaObject::invokeMethod(this, [this] { deliver(); }, Qt::QueuedConnection);
}

void SolidRunner::publishFailure(std::uint64_t job, const std::exception_ptr& error) {
  const std::lock_guard lock(mutex_);
  if (job_.serial != job) return;
  error_ = error;
  if (std::exchange(isDelivering_, true)) return;
  QMetaObject::invokeMethod(this, [this] { deliver(); }, Qt::QueuedConnection);
}

void SolidRunner::deliver() {
  std::optional<SolidReached> newest;
  std::exception_ptr error;
  {
    const std::lock_guard lock(mutex_);
    isDelivering_ = false;
    newest = std::exchange(newest_, std::nullopt);
    error = std::exchange(error_, nullptr);
  }
  if (error) {
    emit failed(error);
  } else if (newest) {
    emit reached(*newest);
  }
}

}  // namespace nearfit::ui
