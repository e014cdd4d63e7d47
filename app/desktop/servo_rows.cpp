#include "app/desktop/servo_rows.h"

#include <utility>

#include "ui/widgets/paths.h"

namespace nearfit::desktop {

void ServoRows::take() {
  rows_.clear();
  for (MotionRow row; queue_->pop(row);)
    rows_.push_back(row);
  if (rows_.empty()) return;
  try {
    if (recorder_) recorder_->write(rows_);
  } catch (...) {
    abandon(std::current_exception());
  }
  const quint64 lost = queue_->dropped();
  emit ticked(rows_, lost - std::exchange(lostTold_, lost));
}

void ServoRows::recordTo(const QString& file, bool isRunning) {
  take();
  finish();
  file_ = file;
  if (isRunning) begin();
  tell();
}

void ServoRows::begin() {
  // Queued rows belong to the run before; a servo that restarts continues the recording.
  take();
  if (file_.isEmpty() || recorder_) return;
  try {
    recorder_ = std::make_unique<MotionRecorder>(ui::toPath(file_));
    lostBefore_ = queue_->dropped();
  } catch (...) {
    abandon(std::current_exception());
  }
}

void ServoRows::finish() {
  take();
  if (!recorder_) return;
  // Nothing was felt: there is nothing to keep, and a file of that name stays as it was.
  const bool isWorthIt = recorder_->rowCount() > 0;
  try {
    if (isWorthIt) recorder_->finish();
  } catch (...) {
    return abandon(std::current_exception());
  }
  const std::unique_ptr<MotionRecorder> recorder = std::move(recorder_);
  const QString file = std::exchange(file_, {});
  tell();
  if (isWorthIt) emit recorded(file, recorder->seconds(), queue_->dropped() - lostBefore_);
}

void ServoRows::tell() {
  emit recordingChanged(file_, recorder_ ? recorder_->seconds() : 0.0);
}

void ServoRows::abandon(const std::exception_ptr& error) {
  std::optional<double> kept;
  try {
    if (recorder_) kept = recorder_->keepWritten();
  } catch (...) {
    // Report the first failure only.
  }
  recorder_.reset();
  const QString file = std::exchange(file_, {});
  tell();
  emit failed(error, kept ? file : QString(), kept.value_or(0.0));
}

}  // namespace nearfit::desktop
