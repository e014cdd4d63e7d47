#include "ui/view3d/scale_bar.h"

#include <QEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/placing/scale_bar.h"
#include "ui/view3d/glyphs/colour_legend.h"
#include "ui/widgets/format.h"
#include "ui/widgets/length_unit.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Distances [pixels]: from the view's edges, from other overlays, and inside the frame.
constexpr int kEdgeMargin = 14, kGap = 8, kTextInset = 9;
/// Height of the bar's end marks, and their distance from the label [pixels].
constexpr int kMarks = 6, kBelowText = 3;
/// Max width of the bar, in heights of a letter.
constexpr int kLetters = 8;

}  // namespace

ScaleBar::ScaleBar(QWidget& view) : QWidget(&view) {
  setObjectName(QStringLiteral("scaleBar"));
  setAttribute(Qt::WA_TransparentForMouseEvents);
  view.installEventFilter(this);
  hide();
}

void ScaleBar::setWanted(bool isWanted) {
  isWanted_ = isWanted;
  place();
}

void ScaleBar::showScale(double metresPerPixel) {
  if (std::exchange(metresPerPixel_, metresPerPixel) != metresPerPixel) update();
  place();
}

int ScaleBar::room() const {
  return kLetters * fontMetrics().height();
}

double ScaleBar::length() const {
  return scaleBarLength(room() * metresPerPixel_, metresOf(shownLengthUnit()));
}

double ScaleBar::pixels() const {
  return metresPerPixel_ > 0.0 ? length() / metresPerPixel_ : 0.0;
}

QString ScaleBar::text() const {
  return formatRoundLength(length());
}

bool ScaleBar::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) place();
  return QWidget::eventFilter(watched, event);
}

void ScaleBar::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange) place();
}

void ScaleBar::place() {
  const bool isShown = isWanted_ && length() > 0.0;
  setVisible(isShown);
  if (!isShown) return;
  const QWidget& view = *parentWidget();
  QRect at(0, 0, room() + 2 * kTextInset, fontMetrics().height() + kBelowText + kMarks + 2 * kTextInset);
  at.moveBottomRight(view.rect().bottomRight() - QPoint(kEdgeMargin, kEdgeMargin));
  const QList<QWidget*> overlays = view.findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly);
  const auto isInTheWay = [&at](const QWidget* overlay) {
    return !overlay->isHidden() && qobject_cast<const ColourLegend*>(overlay) != nullptr &&
           overlay->geometry().intersects(at);
  };
  // Each step goes up, to above what was in the way.
  for (auto found = std::find_if(overlays.begin(), overlays.end(), isInTheWay); found != overlays.end();
       found = std::find_if(overlays.begin(), overlays.end(), isInTheWay))
    at.moveBottom((*found)->geometry().top() - kGap);
  setGeometry(at);
}

void ScaleBar::paintEvent(QPaintEvent*) {
  const QString label = text();
  const int letters = fontMetrics().horizontalAdvance(label);
  const double bar = pixels(), inside = std::max<double>(bar, letters);
  const QRectF frame = QRectF(width() - inside - 2 * kTextInset, 0, inside + 2 * kTextInset, height());
  const bool isDark = isThemeDark();
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(isDark ? QColor(255, 255, 255, 40) : QColor(0, 0, 0, 36), 1.0));
  painter.setBrush(isDark ? QColor(32, 38, 44, 228) : QColor(255, 255, 255, 228));
  painter.drawRoundedRect(frame.adjusted(0.5, 0.5, -0.5, -0.5), 7.0, 7.0);
  const QColor ink = themed(QColor(0x1c, 0x25, 0x2e));
  painter.setPen(ink);
  painter.drawText(QRectF(frame.left(), kTextInset, frame.width(), fontMetrics().height()), Qt::AlignCenter,
                   label);
  const double middle = frame.center().x(), base = height() - kTextInset;
  const QPointF left(middle - 0.5 * bar, base), right(middle + 0.5 * bar, base), up(0.0, -kMarks);
  painter.setPen(QPen(ink, 2.0, Qt::SolidLine, Qt::FlatCap, Qt::MiterJoin));
  painter.drawPolyline(QPolygonF({left + up, left, right, right + up}));
}

}  // namespace nearfit::ui
