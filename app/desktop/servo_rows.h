#pragma once

#include <QObject>
#include <QString>
#include <exception>
#include <memory>
#include <vector>

#include "app/desktop/motion_recorder.h"

namespace nearfit::desktop {

/// Every tick of the servo, taken over from its thread, for whoever plots them, and for the file that is
/// recorded. A recording that cannot be written ends; the servo goes on.
class ServoRows : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  /// For the servo. Always there, so that a recording can begin at any time and plots miss no peak.
  MotionQueue* queue() noexcept { return queue_.get(); }
  /// Takes over what the servo has put there; several times in sixteen seconds.
  void take();

  /// What is felt next is recorded to that file, or from now on if `isRunning`; empty ends a recording, or
  /// what would be one.
  void recordTo(const QString& file, bool isRunning);
  /// The servo starts: what is to be recorded is.
  void begin();
  /// The servo has stopped: the recording is finished.
  void finish();
  /// Says how far the recording is.
  void tell();

 signals:
  /// Every tick since the last time, in order; many at a time where the window was busy.
  /// @param lost  Ticks after them that are missing, as the window was busy for too long.
  void ticked(const std::vector<nearfit::MotionRow>& rows, quint64 lost);
  /// What is recorded, or will be (empty: nothing), and how long that is so far [s].
  void recordingChanged(const QString& file, double seconds);
  /// A recording is whole.
  /// @param lost  Ticks that are not in it, as the window was busy for too long.
  void recorded(const QString& file, double seconds, quint64 lost);
  /// The recording has ended early.
  /// @param file     That keeps what was recorded until then; empty: nothing is kept.
  /// @param seconds  That it covers [s].
  void failed(const std::exception_ptr& error, const QString& file, double seconds);

 private:
  void abandon(const std::exception_ptr& error);

  const std::unique_ptr<MotionQueue> queue_ = std::make_unique<MotionQueue>();
  std::vector<MotionRow> rows_;  ///< Taken last.
  std::unique_ptr<MotionRecorder> recorder_;
  QString file_;
  quint64 lostBefore_ = 0;  ///< By the queue, before the recording began.
  quint64 lostTold_ = 0;    ///< By the queue, as `ticked` has told.
};

}  // namespace nearfit::desktop
