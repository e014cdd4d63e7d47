#include "ui/panels/replay/timeline_track.h"

#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kLinesHigh = 3;   ///< Height in lines of text: as many as there are names.
constexpr int kAbove = 3;       ///< From the edges to the plot [pixels].
constexpr int kBesidePlot = 6;  ///< From the plot to texts [pixels].
constexpr int kSwatch = 14;     ///< Length of the line beside a name [pixels].

/// Lines through points that come in order of x. Of the points in one column of pixels, the lowest and the highest
/// are kept.
class ColumnLines {
 public:
  void add(const QPointF& point) {
    const double column = std::floor(point.x());
    if (hasPoints_ && column != column_) flush();
    if (!hasPoints_ || point.y() < low_.y()) low_ = point;
    if (!hasPoints_ || point.y() > high_.y()) high_ = point;
    column_ = column;
    hasPoints_ = true;
  }
  /// Ends the line; the next point begins another.
  void cut() {
    flush();
    if (!line_.isEmpty()) lines_.push_back(std::exchange(line_, {}));
  }
  std::vector<QPolygonF> take() {
    cut();
    return std::move(lines_);
  }

 private:
  void flush() {
    if (!hasPoints_) return;
    const auto [first, last] =
        std::minmax(low_, high_, [](const QPointF& a, const QPointF& b) { return a.x() < b.x(); });
    line_ << first;
    if (last != first) line_ << last;
    hasPoints_ = false;
  }

  std::vector<QPolygonF> lines_;
  QPolygonF line_;
  QPointF low_, high_;
  double column_ = 0.0;
  bool hasPoints_ = false;
};

void drawLines(QPainter& painter, const std::vector<QPolygonF>& lines, const QColor& colour, double width) {
  painter.setPen(QPen(colour, width, Qt::SolidLine, Qt::RoundCap));
  // A single tick between two gaps is a dot.
  for (const QPolygonF& line : lines)
    line.size() == 1 ? painter.drawPoint(line.first()) : painter.drawPolyline(line);
}

}  // namespace

TrackCurves trackCurves(std::span<const MotionRow> rows, const QRectF& plot) {
  TrackCurves curves;
  for (const MotionRow& row : rows) {
    if (std::isfinite(row.distance)) curves.maxDistance = std::max(curves.maxDistance, row.distance);
    curves.maxMinima = std::max(curves.maxMinima, row.lmds);
  }
  const double duration = rows.empty() ? 0.0 : rows.back().time;
  const auto pointOf = [&](double time, double share) {
    return QPointF(plot.left() + (duration > 0.0 ? time / duration : 0.0) * plot.width(),
                   plot.bottom() - share * plot.height());
  };
  ColumnLines exact, atLeast, minima;
  for (const MotionRow& row : rows) {
    const bool hasDistance = std::isfinite(row.distance);
    if (!hasDistance || row.isDistanceBound) exact.cut();
    if (!hasDistance || !row.isDistanceBound) atLeast.cut();
    if (hasDistance)
      (row.isDistanceBound ? atLeast : exact)
          .add(pointOf(row.time, curves.maxDistance > 0.0 ? row.distance / curves.maxDistance : 0.0));
    if (curves.maxMinima > 0) minima.add(pointOf(row.time, 1.0 * row.lmds / curves.maxMinima));
  }
  curves.exact = exact.take();
  curves.atLeast = atLeast.take();
  curves.minima = minima.take();
  return curves;
}

std::vector<std::pair<QColor, QString>> trackNames(const TrackCurves& curves) {
  std::vector<std::pair<QColor, QString>> names;
  if (!curves.exact.empty()) names.emplace_back(colours::kClearance, TimelineTrack::tr("Min distance"));
  if (!curves.atLeast.empty())
    names.emplace_back(colours::kAtLeast, TimelineTrack::tr("Min distance, at least"));
  if (!curves.minima.empty())
    names.emplace_back(colours::kMutedText,
                       TimelineTrack::tr("Local minima, up to %1").arg(curves.maxMinima));
  return names;
}

TimelineTrack::TimelineTrack(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("timelineTrack"));
  setAccessibleName(tr("Min distance and number of minima over time"));
  setToolTip(tr("Min distance and number of minima over time. Click to go there."));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void TimelineTrack::showRows(std::span<const MotionRow> rows) {
  rows_ = rows;
  time_ = 0.0;
  refresh();
}

void TimelineTrack::setTime(double time) {
  if (time == time_) return;
  time_ = time;
  update();
}

void TimelineTrack::setRange(double from, double to) {
  from_ = from;
  to_ = to;
  update();
}

void TimelineTrack::setMark(std::optional<double> time) {
  mark_ = time;
  update();
}

void TimelineTrack::setEnds(int left, int right) {
  if (left == left_ && right == right_) return;
  left_ = left;
  right_ = right;
  refresh();
}

QRectF TimelineTrack::plot() const {
  return QRectF(left_, kAbove, std::max(right_ - left_, 1), std::max(height() - 2 * kAbove, 1));
}

QSize TimelineTrack::sizeHint() const {
  return {0, kLinesHigh * fontMetrics().lineSpacing() + 2 * kAbove};
}

void TimelineTrack::refresh() {
  curves_ = trackCurves(rows_, plot());
  update();
}

void TimelineTrack::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  refresh();
}

void TimelineTrack::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) seek(event->pos().x());
}

void TimelineTrack::mouseMoveEvent(QMouseEvent* event) {
  if (event->buttons().testFlag(Qt::LeftButton)) seek(event->pos().x());
}

void TimelineTrack::seek(int x) {
  if (rows_.empty()) return;
  emit sought(duration() * std::clamp((x - plot().left()) / plot().width(), 0.0, 1.0));
}

void TimelineTrack::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(plot(), palette().base());
  if (rows_.empty()) return;
  paintAxis(painter);
  paintNames(painter);
  painter.setRenderHint(QPainter::Antialiasing);
  drawLines(painter, curves_.minima, themed(colours::kMutedText), 1.0);
  drawLines(painter, curves_.exact, themed(colours::kClearance), 1.4);
  drawLines(painter, curves_.atLeast, themed(colours::kAtLeast), 1.4);
  paintRange(painter);
  const auto line = [&](double time, const QColor& colour) {
    painter.setPen(QPen(themed(colour), 1.6));
    painter.drawLine(QPointF(xOf(time), plot().top()), QPointF(xOf(time), plot().bottom()));
  };
  if (mark_) line(*mark_, colours::kOverlap);
  line(time_, colours::kMoving);
}

double TimelineTrack::xOf(double time) const {
  const double share = duration() > 0.0 ? std::clamp(time / duration(), 0.0, 1.0) : 0.0;
  return plot().left() + share * plot().width();
}

void TimelineTrack::paintRange(QPainter& painter) const {
  constexpr int kDimmed = 170;
  QColor dim = palette().color(QPalette::Window);
  dim.setAlpha(kDimmed);
  const QRectF all = plot();
  const double left = xOf(from_), right = xOf(std::min(to_, duration()));
  painter.fillRect(QRectF(all.topLeft(), QPointF(left, all.bottom())), dim);
  painter.fillRect(QRectF(QPointF(right, all.top()), all.bottomRight()), dim);
}

void TimelineTrack::paintAxis(QPainter& painter) const {
  const QRectF room(0.0, 0.0, left_ - kBesidePlot, height());
  painter.setPen(themed(colours::kMutedText));
  if (curves_.maxDistance > 0.0)
    painter.drawText(room, Qt::AlignRight | Qt::AlignTop, formatLength(curves_.maxDistance));
  painter.drawText(room, Qt::AlignRight | Qt::AlignBottom, QStringLiteral("0"));
}

void TimelineTrack::paintNames(QPainter& painter) const {
  const double left = right_ + kBesidePlot, text = left + kSwatch + kBesidePlot;
  double y = kAbove;
  for (const auto& [colour, name] : trackNames(curves_)) {
    const QRectF line(text, y, width() - text, fontMetrics().lineSpacing());
    painter.setPen(QPen(themed(colour), 2.0));
    painter.drawLine(QPointF(left, line.center().y()), QPointF(left + kSwatch, line.center().y()));
    painter.setPen(palette().color(QPalette::WindowText));
    painter.drawText(line, Qt::AlignLeft | Qt::AlignVCenter,
                     fontMetrics().elidedText(name, Qt::ElideRight, static_cast<int>(line.width())));
    y += line.height();
  }
}

}  // namespace nearfit::ui
