#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "core/report/plot_history.h"
#include "ui/widgets/error_box.h"

class QComboBox;
class QLabel;
class QToolButton;

namespace nearfit::ui {

class PlotView;

/// Plots what is felt, and how the servo keeps up, over time: live, or of a recording that is played.
class PlotPanel : public QWidget {
  Q_OBJECT

 public:
  explicit PlotPanel(QWidget* parent = nullptr);
  ~PlotPanel() override;

  /// Adds the ticks since the last call, in order; also while a recording is plotted.
  /// @param lost  Ticks missing after these: the lines have a gap there, and the note says so.
  void add(const std::vector<MotionRow>& rows, quint64 lost = 0);
  /// Plots a recording instead of live ticks.
  void showRecording(const std::vector<MotionRow>& rows);
  /// Marks a time of the recording [s].
  void setRecordingTime(double time);
  /// Plots live ticks again.
  void showLive();

 signals:
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
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
  quint64 lost_ = 0;  ///< Ticks missing in the live plots.
};

}  // namespace nearfit::ui
