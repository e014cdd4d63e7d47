#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "core/report/plot_history.h"
#include "ui/dialogs/error_box.h"

class QComboBox;
class QLabel;
class QToolButton;

namespace nearfit::ui {

class PlotView;

/// What is felt, and how the servo keeps up, over time: live, or of a recording that is played.
class PlotPanel : public QWidget {
  Q_OBJECT

 public:
  explicit PlotPanel(QWidget* parent = nullptr);
  ~PlotPanel() override;

  /// Ticks that were done since the last time, in order. What is plotted meanwhile may be a recording.
  /// @param lost  Ticks after these that are missing: the lines have a gap there, and the note says so.
  void add(const std::vector<MotionRow>& rows, quint64 lost = 0);
  /// Plots a recording instead.
  void showRecording(const std::vector<MotionRow>& rows);
  /// The time of it that is looked at [s].
  void setRecordingTime(double time);
  void showLive();

 signals:
  void failed(const nearfit::ui::Failure& failure);
  void noted(const QString& text);

 private:
  void setUpButtons();
  void setPaused(bool isPaused);
  void showNote();
  void followAgain();
  void exportTable();
  void exportPicture();
  QString askForFile(const QString& title, const QString& suffix);
  const PlotHistory& shown() const;

  PlotView* view_;
  QToolButton *pause_, *follow_, *table_, *picture_;
  QComboBox* span_;
  QLabel* note_;
  PlotHistory live_;
  std::optional<PlotHistory> paused_, recording_;
  quint64 lost_ = 0;  ///< Ticks that are missing in what is live.
};

}  // namespace nearfit::ui
