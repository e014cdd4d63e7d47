#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QPointer>
#include <QTimer>
#include <memory>
#include <optional>
#include <vector>

#include "core/scene/motion_playback.h"
#include "core/session.h"
#include "ui/background_task.h"
#include "ui/dialogs/error_box.h"

class QWidget;

namespace nearfit::ui {

class ProgressDialog;
class Timeline;

/// Plays a recording: reads it in another thread, lets time pass, and says what is to be shown. The session
/// is not changed; when the recording is closed, everything is as it was.
class Replay : public QObject {
  Q_OBJECT

 public:
  /// @param session, timeline, window  Outlive this.
  Replay(Session& session, Timeline& timeline, QWidget* window);
  ~Replay() override;

  bool isOpen() const noexcept { return playback_.has_value(); }
  const std::vector<MotionRow>& rows() const { return playback_->rows(); }

  /// Asks for a file and opens it.
  void askAndOpen();
  void open(const QString& file);
  /// Only one moves the part: while the servo does, nothing is shown, and what is open is closed.
  void setAllowed(bool isAllowed);
  /// Puts everything back. Harmless when nothing is open.
  void close();

 signals:
  void opened();
  /// The row that counts is another.
  void rowShown(const nearfit::ServoSnapshot& snapshot);
  void closed();
  void failed(const nearfit::ui::Failure& failure);
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
  PartId moving_{};  ///< That the recording moves.
  std::unique_ptr<ServoSnapshot> shown_;
  QTimer timer_;
  QElapsedTimer sinceLast_;
  bool isAllowed_ = true;
};

}  // namespace nearfit::ui
