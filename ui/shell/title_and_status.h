#pragma once

#include <QObject>
#include <QStatusBar>
#include <cstdint>
#include <optional>

#include "core/servo/servo_tick.h"
#include "core/session/scene_events.h"
#include "ui/model/servo_status.h"

class QLabel;
class QMainWindow;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class HandState;

/// The window's title: the name of the scene, and a mark if it is not saved. A part in hand that has moved is
/// not saved either, although the session does not have its pose yet.
class WindowTitle : public QObject {
  Q_OBJECT

 public:
  /// @param session, hand  Outlive this.
  /// @param window         Becomes the parent.
  WindowTitle(Session& session, const HandState& hand, QMainWindow* window);

 private:
  void show();
  /// Updates the mark.
  void showModified();

  Session& session_;
  const HandState& hand_;
  QMainWindow* window_;
  Subscription changes_;
};

/// The status bar. A note belongs to the command that raised it: it stays for a few seconds, and no longer than the state
/// of the session that it is about or than until the next command. One that is too long is elided, and its tooltip is
/// the whole text.
class NoteBar : public QStatusBar {
  Q_OBJECT

 public:
  /// @param session  Outlives this.
  explicit NoteBar(Session& session, QWidget* parent = nullptr);

  /// Shows a note instead of the one before. What changes until the event loop is back belongs to it.
  void note(const QString& text);
  /// From now on each action of the window that the user triggers ends the note of the one before, except actions
  /// added later.
  void endAtCommandsOf(const QMainWindow& window);
  /// Returns the note as painted; empty if there is none.
  QString shownText() const;

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  /// Ends a note that is not of this moment.
  void endNote();
  /// Ends the note when a command has run, unless the command itself raised it.
  void endNoteOfOtherCommand();
  /// Returns the room left of the permanent widgets.
  QRect room() const;

  Session& session_;
  std::optional<std::uint64_t> state_;  ///< Serial of the state that the note is about.
  int loopLevel_ = 0;                   ///< Level of the event loop in which the note was raised.
  Subscription changes_;
};

/// Servo rate, lateness, number of minima and min distance, at the right of the status bar. While there are no numbers to
/// show, they give way to a note that would be elided.
class StatusReadout : public QObject {
  Q_OBJECT

 public:
  /// @param hand  What it shows.
  /// @param bar   Becomes the parent.
  StatusReadout(const HandState& hand, QStatusBar* bar);

 private:
  void showStatus(const ServoStatus& status);
  /// @param isFelt  False if the snapshot is past: its numbers are grey.
  void showSnapshot(const ServoSnapshot& snapshot, bool isFelt);
  /// Shows dashes instead of minima and distance.
  void clearSnapshot();
  /// True if there is no number to show.
  bool isIdle() const noexcept { return isServoOff_ && isWithoutNumbers_; }
  void setIdle(bool isServoOff, bool isWithoutNumbers);
  /// Hides the numbers if they are none and the bar's note needs their room; else shows them.
  void makeRoom();
  bool eventFilter(QObject* watched, QEvent* event) override;

  QStatusBar* bar_;
  QWidget* row_ = nullptr;
  bool isServoOff_ = true, isWithoutNumbers_ = true;
  QLabel *rate_ = nullptr, *lateness_ = nullptr, *minima_ = nullptr, *distance_ = nullptr;
};

}  // namespace nearfit::ui
