#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/path/assembly_path.h"
#include "core/servo/motion_playback.h"
#include "core/session/session.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QAction;
class QWidget;

namespace nearfit {
struct PathClearance;
}

namespace nearfit::ui {

class HandState;
class MoveGuard;
class Timeline;
class Viewport;

/// Plays a recording or a path in the view, as soon as it is open: reads it in another thread, and shows its
/// rows as time passes. Does not change the session; when the recording is closed, everything is as it was.
/// None is played while a part is in hand: only one may move the part, and the servo does.
class Replay : public QObject {
  Q_OBJECT

 public:
  /// What it plays in; all outlive this.
  struct Context {
    Session& session;
    const HandState& hand;
    MoveGuard& guard;  ///< Told while a recording moves the part.
    Viewport& view;
  };
  /// @param timeline  Outlives this.
  /// @param window    The parent, and that of dialogs.
  Replay(const Context& context, Timeline& timeline, QWidget* window);
  ~Replay() override;

  /// Returns the action that asks for a file and opens it.
  QAction* openAction() const noexcept { return open_; }
  /// Closes the recording and puts everything back; no-op if none is open.
  void close();

  bool isOpen() const noexcept { return playback_.has_value(); }
  /// The path that is open; std::nullopt for a recording, or if nothing is open.
  const std::optional<AssemblyPath>& path() const noexcept { return path_; }
  /// File of the path that is open; empty for a recording, or if nothing is open.
  const std::filesystem::path& pathFile() const noexcept { return pathFile_; }
  /// The motion that is open as a path, from one time of the timeline to another [s]. Its times are those of the
  /// recording or of the path file. Throws UsageError like pathOfMotion() and trimmed().
  AssemblyPath pathBetween(double from, double to) const;
  /// Time on the path at time 0 of the timeline [s].
  double startTime() const noexcept { return path_ ? path_->poses.front().time : 0.0; }
  /// Stops and goes to a time of the timeline [s].
  void goTo(double time);
  /// The path at the times of the rows that play it. There is one.
  AssemblyPath playedPath() const;
  /// Shows clearances along playedPath() as distances.
  void showClearances(const std::vector<PathClearance>& clearances);

 signals:
  /// Emitted when a recording is open, with all its rows, and before the first is shown.
  void opened(const std::vector<nearfit::MotionRow>& rows);
  /// Emitted when the same rows have got distances.
  void rowsChanged(const std::vector<nearfit::MotionRow>& rows);
  /// Emitted with the time [s] of the row that is now shown.
  void timeShown(double time);
  /// Emitted with the row that is now shown, as a tick: its numbers.
  void rowShown(const nearfit::ServoSnapshot& snapshot);
  /// Emitted when the recording was closed.
  void closed();
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  void connectTimeline();
  void askAndOpen();
  /// Opens a recording; no-op while another is being read, or while a part is in hand.
  void open(const QString& file);
  void followHand();
  void begin(const QString& file, std::vector<MotionRow> rows, std::optional<AssemblyPath> path);
  /// Says why a path cannot be played now; empty if it can.
  QString refusalOf(const AssemblyPath& path) const;
  void setPlaying(bool isPlaying);
  void seek(double time);
  void goOn();
  void show();
  void followSession();

  Session& session_;
  const HandState& hand_;
  MoveGuard& guard_;
  Viewport& view_;
  Timeline& timeline_;
  QWidget* window_;
  QAction* open_;
  BackgroundTask task_;
  std::optional<MotionPlayback> playback_;
  std::optional<AssemblyPath> path_;
  std::filesystem::path pathFile_;
  PartId moving_{};                     ///< Part that the recording moves.
  std::optional<GroupId> movingGroup_;  ///< Set if that part leads a group.
  std::unique_ptr<ServoSnapshot> shown_;
  QTimer timer_;
  QElapsedTimer sinceLast_;
  Subscription changes_;
};

}  // namespace nearfit::ui
