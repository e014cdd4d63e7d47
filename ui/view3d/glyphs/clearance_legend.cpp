#include "ui/view3d/glyphs/clearance_legend.h"

#include <QEvent>
#include <QLinearGradient>
#include <QPainter>
#include <algorithm>

#include "core/report/clearance_colours.h"
#include "ui/view3d/glyphs/colour_legend.h"
#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Sizes in heights of a line of text, so that a larger font scales them all.
constexpr double kBarLines = 8.0, kBarWidth = 1.0, kInsetLines = 0.6;
constexpr int kLegendMargin = 14;  ///< To the edge of the view [pixels].
constexpr int kLegendGap = 8;      ///< Between legends [pixels].
constexpr int kIntervals = 4;      ///< Of the scale, between lengths.
constexpr double kPaleOpacity = 0.4;

QColor colourOf(const Colour& c) {
  return QColor::fromRgbF(static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b));
}

QString lengthAt(int interval, double range) {
  return interval == 0 ? ClearanceLegend::tr("contact") : formatLength(range * interval / kIntervals);
}

}  // namespace

ClearanceLegend::ClearanceLegend(QWidget* view) : QWidget(view) {
  setObjectName(QStringLiteral("clearanceLegend"));
  setAccessibleName(tr("Colours of clearances"));
  setAttribute(Qt::WA_TransparentForMouseEvents);
  view->installEventFilter(this);
  hide();
}

void ClearanceLegend::showScale(const Scale& scale) {
  scale_ = scale;
  place();
  show();
  update();
}

QStringList ClearanceLegend::texts() const {
  QStringList texts{tr("Clearance"), tr("beyond")};
  for (int i = 0; i <= kIntervals; ++i)
    texts << lengthAt(i, scale_.range);
  if (scale_.hasOverlap) texts << tr("overlap");
  if (scale_.isStale) texts << tr("of the last pose");
  return texts;
}

QSize ClearanceLegend::sizeHint() const {
  const int line = fontMetrics().lineSpacing(), inset = qRound(kInsetLines * line);
  QFont bold = font();
  bold.setBold(true);
  const QFontMetrics letters(bold);
  int widest = 0;
  const QStringList all = texts();
  for (const QString& text : all)
    widest = std::max(widest, letters.horizontalAdvance(text));
  const int rows = 2 + (scale_.hasOverlap ? 1 : 0) + (scale_.isStale ? 1 : 0);
  return {2 * inset + qRound((kBarWidth + kInsetLines) * line) + widest,
          2 * inset + qRound((kBarLines + 1.0) * line) + rows * qRound(1.2 * line)};
}

bool ClearanceLegend::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::Move:
    case QEvent::Show:
    case QEvent::Hide:
    case QEvent::Resize:
      place();
      break;
    default:
      break;
  }
  return QWidget::eventFilter(watched, event);
}

void ClearanceLegend::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange) place();
}

void ClearanceLegend::place() {
  resize(sizeHint());
  for (auto* legend : parentWidget()->findChildren<ColourLegend*>(QString(), Qt::FindDirectChildrenOnly))
    legend->installEventFilter(this);
  move(clearCorner());
}

QPoint ClearanceLegend::clearCorner() const {
  const QPoint usual(kLegendMargin, kLegendMargin);
  const QRect room = parentWidget()->rect();
  for (const auto* legend :
       parentWidget()->findChildren<ColourLegend*>(QString(), Qt::FindDirectChildrenOnly)) {
    const QRect taken = legend->geometry();
    if (legend->isHidden() || !taken.intersects({usual, size()})) continue;
    for (const QPoint& corner : {QPoint(usual.x(), taken.bottom() + 1 + kLegendGap),
                                 QPoint(taken.right() + 1 + kLegendGap, usual.y())}) {
      if (room.contains({corner, size()})) return corner;
    }
  }
  return usual;
}

void ClearanceLegend::paintSwatch(QPainter& painter, const QRect& at, const QColor& colour,
                                  const QString& text) const {
  const int line = fontMetrics().lineSpacing();
  const QRectF swatch(at.left(), at.top() + 0.1 * line, kBarWidth * line, 0.8 * line);
  // The nearly black of overlaps would vanish on a dark card.
  painter.setPen(QPen(themed(colours::kMutedText), 1.0));
  painter.setBrush(colour);
  painter.drawRoundedRect(swatch, 2.0, 2.0);
  painter.setPen(themed(QColor(0x1c, 0x25, 0x2e)));
  painter.drawText(at.adjusted(qRound((kBarWidth + kInsetLines) * line), 0, 0, 0), Qt::AlignVCenter, text);
}

void ClearanceLegend::paintEvent(QPaintEvent*) {
  const bool isDark = isThemeDark();
  const int line = fontMetrics().lineSpacing(), inset = qRound(kInsetLines * line), row = qRound(1.2 * line);
  const QColor ink = themed(QColor(0x1c, 0x25, 0x2e));
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(isDark ? QColor(255, 255, 255, 40) : QColor(0, 0, 0, 36), 1.0));
  painter.setBrush(isDark ? QColor(32, 38, 44, 228) : QColor(255, 255, 255, 228));
  painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 7.0, 7.0);

  QRect at(inset, inset, width() - 2 * inset, line);
  QFont bold = font();
  bold.setBold(true);
  painter.setFont(bold);
  painter.setPen(ink);
  painter.drawText(at, Qt::AlignVCenter, tr("Clearance"));
  painter.setFont(font());
  at.translate(0, row);
  if (scale_.isStale) {
    painter.setPen(themed(colours::kWarning));
    painter.drawText(at, Qt::AlignVCenter, tr("of the last pose"));
    at.translate(0, row);
  }
  painter.setOpacity(scale_.isStale ? kPaleOpacity : 1.0);
  paintSwatch(painter, at, scale_.beyond, tr("beyond"));
  at.translate(0, row);

  // Far above, near below; half a line for the topmost length.
  const QRectF bar(at.left(), at.top() + 0.5 * line, kBarWidth * line, kBarLines * line);
  QLinearGradient gradient(bar.bottomLeft(), bar.topLeft());
  const auto steps = static_cast<int>(kClearanceStops.size()) - 1;
  for (int i = 0; i <= steps; ++i)
    gradient.setColorAt(static_cast<double>(i) / steps,
                        colourOf(kClearanceStops[static_cast<std::size_t>(i)]));
  painter.setPen(Qt::NoPen);
  painter.setBrush(gradient);
  painter.drawRoundedRect(bar, 2.0, 2.0);
  painter.setPen(ink);
  for (int i = 0; i <= kIntervals; ++i) {
    const double y = bar.bottom() - bar.height() * i / kIntervals;
    const QRectF label(bar.right() + kInsetLines * line, y - 0.5 * line, width(), line);
    painter.drawText(label, Qt::AlignVCenter, lengthAt(i, scale_.range));
  }
  if (!scale_.hasOverlap) return;
  at.moveTop(qRound(bar.bottom() + 0.6 * line));
  paintSwatch(painter, at, colourOf(kOverlapColour), tr("overlap"));
}

}  // namespace nearfit::ui
