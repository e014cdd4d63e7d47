#pragma once

#include <QObject>
#include <QString>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/servo/motion_recording.h"

namespace nearfit::desktop {

/// Writes what the servo does to a file, as `nearfit-cli place --record` does. If the servo restarts
/// meanwhile, the recording's time goes on.
class MotionRecorder {
 public:
  /// Throws FileError.
  explicit MotionRecorder(const std::filesystem::path& file) : writer_(file) {}

  /// Appends rows, in the order of the ticks. Throws FileError.
  void write(const std::vector<MotionRow>& rows) {
    for (MotionRow row : rows) {
      if (count_ > 0 && row.time + offset_ < last_) offset_ = last_ + kTick - row.time;
      row.time += offset_;
      if (count_ == 0) first_ = row.time;
      last_ = row.time;
      ++count_;
      writer_.write(row);
    }
  }
  /// Completes the file. Throws FileError.
  void finish() { writer_.finish(); }
  /// After a failure: keeps what was written before it, as MotionWriter does, and returns
  /// how long that is [s].
  std::optional<double> keepWritten() {
    const std::optional<double> last = writer_.keepWritten();
    return last ? std::optional(*last - first_) : std::nullopt;
  }

  std::size_t rowCount() const noexcept { return count_; }
  /// Returns the time that the recording covers so far [s].
  double seconds() const noexcept { return last_ - first_; }

 private:
  static constexpr double kTick = 1e-3;  ///< [s]

  MotionWriter writer_;
  std::size_t count_ = 0;
  double offset_ = 0.0, first_ = 0.0, last_ = 0.0;  ///< [s]
};

/// Takes every tick from the servo thread, for plots and for a file. A recording that cannot be written ends;
/// the servo goes on.
class ServoRows : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  /// Queue for the servo to fill. Always there, so that a recording can begin at any time and
  /// plots miss no peak.
  MotionQueue* queue() noexcept { return queue_.get(); }
  /// Takes the rows that the servo has queued. The queue holds sixteen seconds: call it far more often.
  void take();

  /// Records what is felt to a file: from now on if `isRunning`, else from the next begin(). Empty: ends the
  /// recording, or the wish for one.
  void recordTo(const QString& file, bool isRunning);
  /// Call it when the servo starts: begins the recording, if one is wanted.
  void begin();
  /// Call it when the servo has stopped: completes the recording.
  void finish();
  /// Emits recordingChanged().
  void tell();

 signals:
  /// Emitted with every tick since the last time, in order; many at a time if the window was busy.
  /// @param lost  Ticks missing after them, because the window was busy for too long.
  void ticked(const std::vector<nearfit::MotionRow>& rows, quint64 lost);
  /// Emitted when the recording changed.
  /// @param file     File that is recorded, or will be; empty: none.
  /// @param seconds  Time recorded so far [s].
  void recordingChanged(const QString& file, double seconds);
  /// Emitted when a recording is complete.
  /// @param lost  Ticks missing in it, because the window was busy for too long.
  void recorded(const QString& file, double seconds, quint64 lost);
  /// Emitted when a recording has ended early.
  /// @param file     File that keeps what was recorded until then; empty: nothing is kept.
  /// @param seconds  Time that it covers [s].
  void failed(const std::exception_ptr& error, const QString& file, double seconds);

 private:
  void abandon(const std::exception_ptr& error);

  const std::unique_ptr<MotionQueue> queue_ = std::make_unique<MotionQueue>();
  std::vector<MotionRow> rows_;  ///< Rows taken last.
  std::unique_ptr<MotionRecorder> recorder_;
  QString file_;
  quint64 lostBefore_ = 0;  ///< Rows that the queue dropped before the recording began.
  quint64 lostTold_ = 0;    ///< Rows that the queue dropped, as far as `ticked` has told.
};

}  // namespace nearfit::desktop
