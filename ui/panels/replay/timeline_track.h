#pragma once

#include <QColor>
#include <QPolygonF>
#include <QRectF>
#include <QString>
#include <QWidget>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/servo/motion_recording.h"

class QPainter;

namespace nearfit::ui {

/// Curves of a recording over its time, as lines in pixels. Each column of pixels keeps its least and its greatest
/// value, so that no peak is lost.
struct TrackCurves {
  /// Min distance: where it is exact, and where only a lower bound is known. Broken where nothing is within the
  /// cutoff, and where one becomes the other.
  std::vector<QPolygonF> exact, atLeast;
  std::vector<QPolygonF> minima;  ///< Number of minima; none if it is always 0.
  double maxDistance = 0.0;       ///< At the top of the plot [m]; 0 if there is no distance.
  std::uint32_t maxMinima = 0;    ///< At the top of the plot.
};

/// Returns the lines of a recording.
/// @param rows  Times begin at 0 and never decrease.
/// @param plot  Where they are drawn: from the first row at the left to the last at the right, 0 at the bottom.
TrackCurves trackCurves(std::span<const MotionRow> rows, const QRectF& plot);

/// Returns the names of the curves that there are, each with its colour in the light theme, from top to bottom.
std::vector<std::pair<QColor, QString>> trackNames(const TrackCurves& curves);

/// Draws the curves of a recording below the scale of a timeline, with the time that is shown. A press goes there.
class TimelineTrack : public QWidget {
  Q_OBJECT

 public:
  explicit TimelineTrack(QWidget* parent = nullptr);

  /// @param rows  Stay until the next call; empty: there is no recording.
  void showRows(std::span<const MotionRow> rows);
  /// @param time  [s]
  void setTime(double time);
  /// Dims what is before and after these times [s].
  void setRange(double from, double to);
  /// Marks a time as a place to look at [s]; std::nullopt: none.
  void setMark(std::optional<double> time);
  /// Sets where the recording begins and ends [pixels]; the axis is to the left, the names are to the right.
  void setEnds(int left, int right);

  const TrackCurves& curves() const noexcept { return curves_; }
  /// Returns where the curves are drawn [pixels].
  QRectF plot() const;

  QSize sizeHint() const override;

 signals:
  /// Emitted with the time [s] that the user presses or drags to.
  void sought(double time);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;

 private:
  void refresh();
  void seek(int x);
  void paintAxis(QPainter& painter) const;
  void paintNames(QPainter& painter) const;
  void paintRange(QPainter& painter) const;
  /// Where a time is in the plot [pixels].
  double xOf(double time) const;
  double duration() const noexcept { return rows_.empty() ? 0.0 : rows_.back().time; }

  std::span<const MotionRow> rows_;
  TrackCurves curves_;
  double time_ = 0.0;
  double from_ = 0.0, to_ = std::numeric_limits<double>::infinity();  ///< [s]
  std::optional<double> mark_;                                        ///< [s]
  int left_ = 0, right_ = 0;
};

}  // namespace nearfit::ui
