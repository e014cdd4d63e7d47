#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QPointer>
#include <QTimer>
#include <memory>
#include <optional>
#include <vector>

#include "core/servo/motion_playback.h"
#include "core/session/session.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QWidget;

namespace nearfit::ui {

class ProgressDialog;
class Timeline;

/// Plays a recording: reads it in another thread, lets time pass, and tells what to show. Does not change the
/// session; when the recording is closed, everything is as it was.
class Replay : public QObject {
  Q_OBJECT

 public:
  /// @param session   Must outlive this.
  /// @param timeline  Must outlive this.
  /// @param window    Must outlive this.
  Replay(Session& session, Timeline& timeline, QWidget* window);
  ~Replay() override;

  bool isOpen() const noexcept { return playback_.has_value(); }
  /// Returns the rows of the recording; only while one is open.
  const std::vector<MotionRow>& rows() const { return playback_->rows(); }

  /// Asks for a file and opens it.
  void askAndOpen();
  /// Opens a recording; no-op while another is being read, or while not allowed.
  void open(const QString& file);
  /// Allows replay, or closes an open recording and shows nothing: only one may move the part,
  /// and the servo does.
  void setAllowed(bool isAllowed);
  /// Closes the recording and puts everything back; no-op if none is open.
  void close();

 signals:
  /// Emitted when a recording is open.
  void opened();
  /// Emitted with the row to show, as a snapshot.
  void rowShown(const nearfit::ServoSnapshot& snapshot);
  /// Emitted when the recording was closed.
  void closed();
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  void connectTimeline();
  void begin(const QString& file, std::vector<MotionRow> rows);
  void setPlaying(bool isPlaying);
  void seek(double time);
  void goOn();
  void show();
  void followSession();

  Session& session_;
  Timeline& timeline_;
  QWidget* window_;
  BackgroundTask task_;
  QPointer<ProgressDialog> progress_;
  std::optional<MotionPlayback> playback_;
  PartId moving_{};  ///< Part that the recording moves.
  std::unique_ptr<ServoSnapshot> shown_;
  QTimer timer_;
  QElapsedTimer sinceLast_;
  bool isAllowed_ = true;
  Subscription changes_;
};

}  // namespace nearfit::ui
