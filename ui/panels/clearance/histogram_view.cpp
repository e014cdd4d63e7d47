#include "ui/panels/clearance/histogram_view.h"

#include <QHelpEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/report/clearance_colours.h"
#include "ui/widgets/format.h"
#include "ui/widgets/length_unit.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kTop = 8, kSide = 12, kTickLength = 4, kTextGap = 8;  ///< [pixels]
constexpr double kStaleOpacity = 0.4;
constexpr int kTickIntervals = 4;

QColor barColour(const ClearanceBin& bin, double range) {
  const Colour c = clearanceColour(0.5 * (bin.from + bin.to), range);
  return QColor::fromRgbF(static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b));
}

}  // namespace

QString formatArea(double squareMetres) {
  constexpr double kInch = 0.0254, kCentimetre = 1e-2, kMillimetre = 1e-3;
  const LengthUnit unit = shownLengthUnit();
  if (unit == LengthUnit::Inch)
    return HistogramView::tr("%1 in²").arg(formatNumber(squareMetres / (kInch * kInch)));
  if (unit == LengthUnit::Metre || squareMetres >= 1.0)
    return HistogramView::tr("%1 m²").arg(formatNumber(squareMetres));
  // Below a square centimetre, square millimetres have the better figures.
  const bool isSmall = unit == LengthUnit::Millimetre && squareMetres < kCentimetre * kCentimetre;
  const double side = isSmall ? kMillimetre : kCentimetre;
  const double number = squareMetres / (side * side);
  const int decimals = number >= 100.0 ? 0 : number >= 10.0 ? 1 : 2;
  return (isSmall ? HistogramView::tr("%1 mm²") : HistogramView::tr("%1 cm²"))
      .arg(formatFixed(number, decimals));
}

QString formatShare(double share) {
  const double percent = 100.0 * share;
  const bool isFine = percent > 0.0 && percent < 1.0;
  return HistogramView::tr("%1 %").arg(formatFixed(percent, isFine ? 1 : 0));
}

HistogramView::HistogramView(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("clearanceHistogram"));
  setAccessibleName(tr("Area by clearance"));
  setMinimumSize(220, 90);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void HistogramView::showBins(std::vector<ClearanceBin> bins, double range, double total) {
  bins_ = std::move(bins);
  range_ = range;
  total_ = total;
  update();
}

void HistogramView::setThreshold(double threshold) {
  threshold_ = threshold;
  update();
}

void HistogramView::setStale(bool isStale) {
  if (std::exchange(isStale_, isStale) != isStale) update();
}

QRect HistogramView::chart() const {
  const int below = fontMetrics().lineSpacing() + kTickLength + 4;
  return rect().adjusted(kSide, kTop, -kSide, -below);
}

double HistogramView::pixelOf(double distance) const {
  const QRect within = chart();
  const double from = bins_.front().from, to = bins_.back().to;
  return within.left() + within.width() * (distance - from) / (to - from);
}

void HistogramView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const QRect within = chart();
  const QColor ink = palette().color(QPalette::WindowText);
  QColor faint = ink;
  faint.setAlphaF(0.25);
  painter.setPen(faint);
  painter.drawLine(within.bottomLeft(), within.bottomRight());
  if (bins_.empty() || within.width() <= 0 || within.height() <= 0) return;

  const double most = std::ranges::max(bins_, {}, &ClearanceBin::area).area;
  painter.setOpacity(isStale_ ? kStaleOpacity : 1.0);
  for (const ClearanceBin& bin : bins_) {
    if (!(bin.area > 0.0)) continue;
    // However little it is, it is seen.
    const double height = std::max(1.0, within.height() * bin.area / most);
    const double left = pixelOf(bin.from), right = pixelOf(bin.to);
    const QRectF bar(left, within.bottom() - height, std::max(1.0, right - left - 1.0), height);
    painter.fillRect(bar, barColour(bin, range_));
    painter.setPen(faint);
    painter.drawRect(bar);
  }
  painter.setOpacity(1.0);
  painter.setPen(ink);
  double free = 0.0;  // Where the next text may begin.
  for (int i = 0; i <= kTickIntervals; ++i) {
    const double distance = range_ * i / kTickIntervals, x = pixelOf(distance);
    painter.drawLine(QPointF(x, within.bottom()), QPointF(x, within.bottom() + kTickLength));
    const QString text = i == 0 ? QStringLiteral("0") : formatLength(distance);
    const int wide = fontMetrics().horizontalAdvance(text);
    const double left = std::clamp(x - 0.5 * wide, 0.0, std::max(0.0, static_cast<double>(width() - wide)));
    // The last tick always has its text, and those before it only where they leave room for that.
    const int last = fontMetrics().horizontalAdvance(formatLength(range_));
    if (left < free || (i < kTickIntervals && left + wide + kTextGap > width() - last)) continue;
    free = left + wide + kTextGap;
    painter.drawText(QPointF(left, within.bottom() + kTickLength + fontMetrics().ascent() + 1), text);
  }
  if (!(threshold_ > bins_.front().from && threshold_ < bins_.back().to)) return;
  painter.setPen(QPen(colours::kAccent, 1.4, Qt::DashLine));
  const double x = pixelOf(threshold_);
  painter.drawLine(QPointF(x, within.top()), QPointF(x, within.bottom()));
}

bool HistogramView::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto& help = static_cast<const QHelpEvent&>(*event);
  const auto under = std::ranges::find_if(bins_, [&](const ClearanceBin& bin) {
    return help.x() >= pixelOf(bin.from) && help.x() < pixelOf(bin.to);
  });
  if (under == bins_.end()) {
    QToolTip::hideText();
    event->ignore();
    return true;
  }
  const double share = total_ > 0.0 ? under->area / total_ : 0.0;
  QToolTip::showText(help.globalPos(),
                     tr("%1 to %2: %3 (%4)")
                         .arg(formatLength(under->from), formatLength(under->to), formatArea(under->area),
                              formatShare(share)),
                     this);
  return true;
}

}  // namespace nearfit::ui
