#include "ui/panels/plots/plot_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ui/widgets/font_scale.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

const QColor kTick(0x1f, 0x73, 0xd0), kLate(0xe2, 0x71, 0x1d);

constexpr std::size_t kClearancePane = 2;
constexpr QSize kUsualSize(320, 180);  ///< [pixels]
/// Max number of numbers along an axis, as wanted of its ticker.
constexpr int kMostValues = 4, kMostTimes = 5;
/// A ticker takes round steps, the shortest about this share of those wanted.
constexpr double kShortestStep = 0.65;

/// Wants as many numbers along an axis as there is room for, at most `most`; none where there is not room for one.
/// True if that changed anything.
bool fitTicks(QCPAxis& axis, double room, double ofNumber, int most) {
  const int count = std::min(static_cast<int>(kShortestStep * room / ofNumber), most);
  const bool hasNumbers = count > 0;
  if (axis.tickLabels() == hasNumbers && axis.ticker()->tickCount() == std::max(count, 1)) return false;
  axis.setTickLabels(hasNumbers);
  axis.ticker()->setTickCount(std::max(count, 1));
  return true;
}

/// Returns a range from zero to above the greatest value, with room for the title; never empty.
QCPRange valueRange(double greatest) {
  constexpr double kRoom = 1.35;
  return {0.0, greatest > 0.0 ? kRoom * greatest : 1.0};
}

}  // namespace

PlotView::PlotView(QWidget* parent) : QCustomPlot(parent) {
  setObjectName(QStringLiteral("plotView"));
  setAccessibleName(tr("Force, torque, clearance and times of the servo over time"));
  setFocusPolicy(Qt::StrongFocus);
  // As low as the plots can be read, in a small window.
  setMinimumSize(forFont(*this, kUsualSize.width()), forFont(*this, 140));
  setAutoAddPlottableToLegend(false);
  // With many short lines antialiasing is invisible, and costs several times as much.
  setNotAntialiasedElements(QCP::aePlottables);
  setInteractions(QCP::iRangeDrag | QCP::iRangeZoom);
  plotLayout()->clear();
  addPane(0, 0, tr("Force [N]"), {{PlotChannel::Force, colours::kForce}}, 1.0);
  addPane(0, 1, tr("Torque [mN·m]"), {{PlotChannel::Torque, colours::kTorque}}, 1e3);
  addPane(1, 0, tr("Clearance [mm]"),
          {{PlotChannel::Clearance, colours::kClearance}, {PlotChannel::AtLeast, colours::kAtLeast}}, 1e3);
  addPane(1, 1, tr("Servo [µs]"), {{PlotChannel::TickTime, kTick}, {PlotChannel::Lateness, kLate}}, 1e6);
  addLegend(panes_[kClearancePane], {tr("exact"), tr("at least")});
  addLegend(panes_.back(), {tr("tick"), tr("lateness")});
  plotLayout()->setColumnSpacing(4);
  plotLayout()->setRowSpacing(2);
  applyPalette();
  connect(this, &QCustomPlot::afterLayout, this, &PlotView::fitLegends);
  // Between layout and drawing an axis that gets labels would lack their texts.
  connect(this, &QCustomPlot::afterReplot, this, &PlotView::fitNumbers);
  timer_.setSingleShot(true);
  timer_.setInterval(kMinRedrawMs);
  connect(&timer_, &QTimer::timeout, this, [this] {
    if (isDue_) drawPanes();
  });
}

QSize PlotView::sizeHint() const {
  return QCustomPlot::sizeHint().expandedTo(
      {forFont(*this, kUsualSize.width()), forFont(*this, kUsualSize.height())});
}

void PlotView::addPane(int row, int column, const QString& label,
                       const std::vector<std::pair<PlotChannel, QColor>>& channels, double scale) {
  Pane pane;
  pane.rect = new QCPAxisRect(this);
  plotLayout()->addElement(row, column, pane.rect);
  QCPAxis* time = pane.rect->axis(QCPAxis::atBottom);
  QCPAxis* value = pane.rect->axis(QCPAxis::atLeft);
  // Inside the pane: beside the axis a low plot would cut it off.
  auto* title = new QCPTextElement(this, label);
  pane.rect->insetLayout()->addElement(title, Qt::AlignTop | Qt::AlignLeft);
  // Clear of the axis and its ticks.
  constexpr int kBesideAxis = 6;
  title->setMargins({kBesideAxis, 0, 0, 0});
  titles_.push_back(title);
  time->setLabel(row == 1 ? tr("Time [s]") : QString());
  value->ticker()->setTickCount(kMostValues);
  pane.rect->setMinimumMargins({0, 4, 6, 0});
  // The value axis scales itself.
  pane.rect->setRangeZoom(Qt::Horizontal);
  pane.rect->setRangeDrag(Qt::Horizontal);
  connect(time, QOverload<const QCPRange&>::of(&QCPAxis::rangeChanged), this, &PlotView::takeUserRange);
  for (const auto& [channel, colour] : channels) {
    QCPGraph* graph = addGraph(time, value);
    graph->setPen(QPen(colour, 1.2));
    graph->setAdaptiveSampling(false);
    pane.lines.push_back({channel, graph, scale});
  }
  pane.cursor = new QCPItemStraightLine(this);
  pane.cursor->setClipAxisRect(pane.rect);
  for (QCPItemPosition* point : {pane.cursor->point1, pane.cursor->point2})
    point->setAxes(time, value);
  pane.cursor->setVisible(false);
  panes_.push_back(std::move(pane));
}

void PlotView::addLegend(Pane& pane, const QStringList& lineNames) {
  auto* names = new QCPLegend;
  pane.rect->insetLayout()->addElement(names, Qt::AlignTop | Qt::AlignRight);
  names->setLayer(QStringLiteral("legend"));
  for (int i = 0; i < lineNames.size(); ++i) {
    QCPGraph* graph = pane.lines[static_cast<std::size_t>(i)].graph;
    graph->setName(lineNames[i]);
    graph->addToLegend(names);
  }
  names->setFillOrder(QCPLegend::foColumnsFirst);
  names->setBorderPen(Qt::NoPen);
  names->setMargins({4, 1, 4, 1});
  names->setIconSize(14, 8);
  pane.legend = names;
}

/// A legend that would lie over its pane's title is left out.
void PlotView::fitLegends() {
  const auto widthOf = [](const QCPLayoutElement& element) { return element.minimumOuterSizeHint().width(); };
  for (std::size_t i = 0; i < panes_.size(); ++i) {
    const Pane& pane = panes_[i];
    if (pane.legend == nullptr) continue;
    const int wide = widthOf(*titles_[i]) + widthOf(*pane.legend);
    pane.legend->setVisible(wide <= pane.rect->width());
  }
}

/// Numbers that would lie over each other are left out.
void PlotView::fitNumbers() {
  bool isOther = false;
  for (const Pane& pane : panes_) {
    QCPAxis &value = *pane.rect->axis(QCPAxis::atLeft), &time = *pane.rect->axis(QCPAxis::atBottom);
    const int line = QFontMetrics(value.tickLabelFont()).lineSpacing();
    const int longest = QFontMetrics(time.tickLabelFont()).horizontalAdvance(QStringLiteral("0000.0"));
    isOther = fitTicks(value, pane.rect->height(), line, kMostValues) || isOther;
    isOther = fitTicks(time, pane.rect->width(), longest, kMostTimes) || isOther;
  }
  // Heights do not depend on the ticks, so that the next picture is the last.
  if (isOther) replot(rpQueuedReplot);
}

void PlotView::applyPalette() {
  const QColor text = palette().color(QPalette::WindowText), base = palette().color(QPalette::Base);
  QColor grid = text;
  grid.setAlphaF(0.14);
  QFont small = font();
  small.setPointSizeF(0.85 * font().pointSizeF());
  setBackground(base);
  for (Pane& pane : panes_) {
    pane.cursor->setPen(QPen(colours::kMoving, 1.6));
    for (QCPAxis* axis : pane.rect->axes()) {
      axis->setBasePen(QPen(text));
      axis->setTickPen(QPen(text));
      axis->setSubTickPen(QPen(text));
      axis->setLabelColor(text);
      axis->setTickLabelColor(text);
      axis->setLabelFont(small);
      axis->setTickLabelFont(small);
      axis->grid()->setPen(QPen(grid, 1.0));
      axis->grid()->setZeroLinePen(QPen(grid, 1.0));
    }
  }
  for (QCPTextElement* title : titles_) {
    title->setFont(small);
    title->setTextColor(text);
  }
  QColor plate = base;
  plate.setAlphaF(0.8);
  for (const Pane& pane : panes_) {
    if (pane.legend == nullptr) continue;
    pane.legend->setBrush(plate);
    pane.legend->setTextColor(text);
    pane.legend->setFont(small);
  }
}

void PlotView::setHistory(const PlotHistory* history) {
  history_ = history;
  refresh();
}

void PlotView::refresh() {
  isDue_ = true;
  // Draw the first change at once, so that a scrubbed time does not lag behind.
  if (isVisible() && !timer_.isActive()) drawPanes();
}

void PlotView::follow(double seconds) {
  span_ = seconds;
  isFollowing_ = true;
  emit followingChanged(true);
  refresh();
}

void PlotView::setCursorTime(std::optional<double> time) {
  if (time == cursorTime_) return;
  cursorTime_ = time;
  refresh();
}

QCPRange PlotView::timeRange() const {
  return range_;
}

QCPRange PlotView::followedRange() const {
  constexpr double kMin = 0.5;
  const double begin = history_ != nullptr ? history_->beginTime() : 0.0;
  const double end = history_ != nullptr ? history_->endTime() : 0.0;
  if (!std::isfinite(span_)) return {begin, std::max(end, begin + kMin)};
  return end < begin + span_ ? QCPRange(begin, begin + span_) : QCPRange(end - span_, end);
}

void PlotView::takeUserRange(const QCPRange& range) {
  if (isSettingRange_) return;
  range_ = range;
  if (isFollowing_) {
    isFollowing_ = false;
    emit followingChanged(false);
  }
  refresh();
}

void PlotView::drawPanes() {
  isDue_ = false;
  timer_.start();
  ++redraws_;
  if (isFollowing_) range_ = followedRange();
  isSettingRange_ = true;
  for (Pane& pane : panes_)
    drawPane(pane, range_);
  isSettingRange_ = false;
  replot(rpQueuedReplot);
}

void PlotView::drawPane(Pane& pane, const QCPRange& range) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double greatest = 0.0;
  const auto columns = static_cast<std::size_t>(std::max(pane.rect->width(), 50));
  for (Line& line : pane.lines) {
    points_.clear();
    if (history_ != nullptr && range.size() > 0.0)
      history_->envelope(line.channel, range.lower, range.upper, columns, points_);
    QVector<QCPGraphData> drawn;
    drawn.reserve(static_cast<int>(points_.size()));
    for (const PlotPoint& point : points_) {
      const double value = std::isfinite(point.value) ? line.scale * point.value : kNone;
      drawn.append({point.time, value});
      if (value > greatest) greatest = value;
    }
    line.graph->data()->set(drawn, true);
  }
  pane.rect->axis(QCPAxis::atBottom)->setRange(range);
  pane.rect->axis(QCPAxis::atLeft)->setRange(belowTitle(valueRange(greatest), pane));
  pane.cursor->setVisible(cursorTime_.has_value());
  if (!cursorTime_) return;
  pane.cursor->point1->setCoords(*cursorTime_, 0.0);
  pane.cursor->point2->setCoords(*cursorTime_, 1.0);
}

QCPRange PlotView::belowTitle(const QCPRange& values, const Pane& pane) const {
  constexpr int kTitleMargin = 6;  // [pixels]
  const int title = QFontMetrics(titles_.front()->font()).lineSpacing() + kTitleMargin;
  const int room = std::max(pane.rect->height(), 2 * title);
  return {values.lower, values.lower + values.size() * room / (room - title)};
}

void PlotView::showEvent(QShowEvent* event) {
  QCustomPlot::showEvent(event);
  refresh();
}

void PlotView::changeEvent(QEvent* event) {
  QCustomPlot::changeEvent(event);
  if (event->type() != QEvent::PaletteChange && event->type() != QEvent::FontChange) return;
  applyPalette();
  refresh();
}

void PlotView::resizeEvent(QResizeEvent* event) {
  QCustomPlot::resizeEvent(event);
  refresh();
}

}  // namespace nearfit::ui
