#pragma once

#include <QTimer>
#include <array>
#include <optional>
#include <vector>

#include <qcustomplot.h>

#include "core/report/plot_history.h"

namespace nearfit::ui {

/// Draws what a run felt over time, in four plots with one time axis: force, torque, clearance, and the
/// servo's times. Follows the newest ticks until the user zooms (wheel) or drags. Draws at most thirty times
/// a second, and not at all while hidden or without new data. No peak is lost, however long the time shown.
class PlotView : public QCustomPlot {
  Q_OBJECT

 public:
  static constexpr int kMinRedrawMs = 33;

  explicit PlotView(QWidget* parent = nullptr);

  /// Sets what to draw; null draws nothing. It must outlive this, or stay until the next call.
  void setHistory(const PlotHistory* history);
  /// Draws again after the history has changed.
  void refresh();
  /// Shows the newest `seconds` and follows them; infinity shows all.
  void follow(double seconds);
  bool isFollowing() const noexcept { return isFollowing_; }
  /// Draws a vertical line at a time [s]; std::nullopt removes it.
  void setCursorTime(std::optional<double> time);
  /// Returns the time range shown [s].
  QCPRange timeRange() const;
  /// Returns the number of pictures drawn so far, for tests.
  int redrawCount() const noexcept { return redraws_; }

  /// The size of a panel that has room.
  QSize sizeHint() const override;

 signals:
  /// Emitted with false when the user zoomed or dragged, with true when follow() was called.
  void followingChanged(bool isFollowing);

 protected:
  void showEvent(QShowEvent* event) override;
  void changeEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  struct Line {
    PlotChannel channel;
    QCPGraph* graph;
    double scale;  ///< Drawn units per SI unit.
  };
  struct Pane {
    QCPAxisRect* rect = nullptr;
    QCPItemStraightLine* cursor = nullptr;
    std::vector<Line> lines;
    QCPLegend* legend = nullptr;  ///< Null if it has one line.
  };
  void addPane(int row, int column, const QString& label,
               const std::vector<std::pair<PlotChannel, QColor>>& channels, double scale);
  void addLegend(Pane& pane, const QStringList& lineNames);
  void fitLegends();
  void fitNumbers();
  void applyPalette();
  void takeUserRange(const QCPRange& range);
  void drawPanes();
  void drawPane(Pane& pane, const QCPRange& range);
  QCPRange followedRange() const;
  /// Returns the range extended at the top, to make room for the pane's title and legend.
  QCPRange belowTitle(const QCPRange& values, const Pane& pane) const;

  const PlotHistory* history_ = nullptr;
  std::vector<Pane> panes_;
  std::vector<QCPTextElement*> titles_;
  std::vector<PlotPoint> points_;
  QTimer timer_;
  double span_ = 10.0;
  QCPRange range_{0.0, 10.0};
  std::optional<double> cursorTime_;
  bool isFollowing_ = true, isDue_ = false, isSettingRange_ = false;
  int redraws_ = 0;
};

}  // namespace nearfit::ui
