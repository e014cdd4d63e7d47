#pragma once

#include <QWidget>
#include <optional>
#include <span>
#include <utility>

#include "core/servo/motion_recording.h"

class QComboBox;
class QLabel;
class QMenu;
class QSlider;
class QToolButton;

namespace nearfit::ui {

class TimelineTrack;

/// Buttons, time scale and curves for playing a recording. As high as its content.
class Timeline : public QWidget {
  Q_OBJECT

 public:
  explicit Timeline(QWidget* parent = nullptr);

  /// @param name  Name of the recording; empty: there is none, and the controls are disabled.
  /// @param rows  Its rows; stay until the next call.
  void showRecording(const QString& name, std::span<const MotionRow> rows);
  /// @param time  [s]
  /// @param note  What the row there says, in words.
  void showTime(double time, const QString& note);
  void showPlaying(bool isPlaying);
  /// Draws other values of the same rows, such as distances that were found; they stay until the next call.
  void showRows(std::span<const MotionRow> rows);
  /// Shows commands behind a button.
  void setPathMenu(QMenu* menu);
  /// Says in words what was found of the motion; empty: nothing.
  /// @param mark  Time that it is about, which the track marks [s].
  void showResult(const QString& text, std::optional<double> mark = std::nullopt);

  /// Time of the last row [s]; 0 if there is none.
  double duration() const noexcept { return duration_; }
  /// Time that is shown [s].
  double time() const noexcept { return shownTime_; }
  /// The times from which and to which commands take the motion [s]; all of it at first.
  std::pair<double, double> range() const noexcept { return {from_, to_}; }
  /// Sets the range, clamped to the motion; ignored unless `from` is before `to`.
  void setRange(double from, double to);

 signals:
  /// Each is emitted when the user asks for what its name says. `time` is in [s], negative `rows` go back,
  /// `speed` is a multiple of real time.
  void playToggled();
  void sought(double time);
  void stepped(int rows);
  void speedChosen(double speed);
  void loopingChosen(bool isLooping);
  void openWanted();
  void closeWanted();

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  QToolButton* make(const char* name, const QString& text, const char* iconName);
  void setUpButtons();
  void setUpScale();

  QToolButton *open_, *back_, *play_, *forward_, *loop_, *path_, *close_;
  QSlider* scale_;
  TimelineTrack* track_;
  QComboBox* speed_;
  QLabel *name_, *time_, *note_, *result_;
  double duration_ = 0.0, shownTime_ = 0.0, from_ = 0.0, to_ = 0.0;  ///< [s]
};

}  // namespace nearfit::ui
