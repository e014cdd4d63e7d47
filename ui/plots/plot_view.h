#pragma once

#include <QTimer>
#include <array>
#include <optional>
#include <vector>

#include <qcustomplot.h>

#include "core/report/plot_history.h"

namespace nearfit::ui {

/// Draws what a run felt over time: force, torque, clearance, and the servo's times, four plots over one
/// time. Follows the newest until the user zooms (wheel) or drags. Draws at most thirty times a second, and
/// not at all while hidden or when nothing is new. No peak is lost, however long the time shown is.
class PlotView : public QCustomPlot {
  Q_OBJECT

 public:
  static constexpr int kLeastRedrawMs = 33;

  explicit PlotView(QWidget* parent = nullptr);

  /// Draws that from now on; null draws nothing. It outlives this, or the next call.
  void setHistory(const PlotHistory* history);
  /// What setHistory gave has changed.
  void refresh();
  /// The newest so many seconds, and following them; infinity: all that there is.
  void follow(double seconds);
  bool isFollowing() const noexcept { return isFollowing_; }
  /// A vertical line at a time [s]; nothing: none.
  void setCursorTime(std::optional<double> time);
  /// The time that is shown [s].
  QCPRange timeRange() const;
  /// Pictures drawn since the start, for tests.
  int redrawCount() const noexcept { return redraws_; }

 signals:
  /// The user has zoomed or dragged, or follow() was called.
  void followingChanged(bool isFollowing);

 protected:
  void showEvent(QShowEvent* event) override;
  void changeEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  struct Line {
    PlotChannel channel;
    QCPGraph* graph;
    double scale;  ///< Units drawn to the SI unit.
  };
  struct Pane {
    QCPAxisRect* rect;
    QCPItemStraightLine* cursor;
    std::vector<Line> lines;
  };
  void addPane(int row, int column, const QString& label,
               const std::vector<std::pair<PlotChannel, QColor>>& channels, double scale);
  void setUpLegend();
  void applyPalette();
  void takeUserRange(const QCPRange& range);
  void drawPanes();
  void drawPane(Pane& pane, const QCPRange& range);
  QCPRange followedRange() const;
  /// The values with room above them for the pane's title and legend.
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
