#pragma once

#include <QWidget>
#include <span>

#include "core/servo/motion_recording.h"

class QComboBox;
class QLabel;
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

  QToolButton *open_, *back_, *play_, *forward_, *loop_, *close_;
  QSlider* scale_;
  TimelineTrack* track_;
  QComboBox* speed_;
  QLabel *name_, *time_, *note_;
  double duration_ = 0.0;
};

}  // namespace nearfit::ui
