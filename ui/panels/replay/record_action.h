#pragma once

#include <QAction>

namespace nearfit::ui {

class HandState;

/// Starts and stops recording what is felt. Its text says what is recorded.
class RecordAction : public QAction {
  Q_OBJECT

 public:
  /// @param hand    Outlives this.
  /// @param window  The parent, and that of dialogs.
  RecordAction(const HandState& hand, QWidget* window);

 public slots:
  /// Shows what is recorded, or will be; empty: nothing.
  /// @param seconds  Length so far [s].
  void showRecording(const QString& file, double seconds);
  /// Tells that a recording is complete.
  /// @param seconds  Its length [s].
  /// @param lost     Ticks missing in it.
  void showRecorded(const QString& file, double seconds, quint64 lost);
  /// Tells that recording has ended early; the failure itself is shown elsewhere.
  void showFailed();

 signals:
  /// Emitted with the file to record to; empty: stop recording.
  void recordRequested(const QString& file);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  /// Asks for a file and starts.
  void askAndStart();

  QWidget* window_;
  const HandState& hand_;
};

}  // namespace nearfit::ui
