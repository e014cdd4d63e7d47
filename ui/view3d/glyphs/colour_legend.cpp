#include "ui/view3d/glyphs/colour_legend.h"

#include <QFontInfo>
#include <QMouseEvent>
#include <QPainter>
#include <QSettings>
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "ui/model/hand_lead.h"
#include "ui/widgets/distance_colours.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

const QString kPlace = QStringLiteral("view/legendPlace");
constexpr int kMargin = 14;  ///< To the edges of the parent.
constexpr int kLegendWidth = 226, kInset = 14;
constexpr int kBarTop = 34, kBarHeight = 11;
constexpr int kFirstRow = 86, kRowHeight = 22, kBelowLastRow = 16;  ///< Row positions are baselines.
constexpr int kGlyphWidth = 25;
/// Opacity of values that are past: readable, and plainly not of now. On a dark card colours lose more.
constexpr double kPastOpacity = 0.5, kPastOpacityOnDark = 0.75;

void paintArrow(QPainter& painter, int y, const QColor& colour) {
  painter.setPen(QPen(colour, 2.6, Qt::SolidLine, Qt::FlatCap));
  painter.drawLine(QPointF(kInset, y - 4.5), QPointF(kInset + 18, y - 4.5));
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour);
  painter.drawPolygon(QPolygonF({QPointF(kInset + 16, y - 9.5), QPointF(kInset + kGlyphWidth, y - 4.5),
                                 QPointF(kInset + 16, y + 0.5)}));
}

void paintDisc(QPainter& painter, int y) {
  painter.setPen(QPen(Qt::white, 1.5));
  painter.setBrush(colours::kContact);
  painter.drawEllipse(QPointF(kInset + 0.5 * kGlyphWidth, y - 4.5), 8.0, 4.5);
}

void paintGhost(QPainter& painter, int y) {
  painter.setPen(QPen(colours::kHand, 1.4));
  QColor fill = colours::kHand;
  fill.setAlphaF(0.2);
  painter.setBrush(fill);
  painter.drawRoundedRect(QRectF(kInset + 4, y - 11, kGlyphWidth - 8, 13), 2.0, 2.0);
}

QColor textColour() {
  return isThemeDark() ? QColor(0xe8, 0xed, 0xf2) : QColor(0x2b, 0x35, 0x3f);
}

QColor mutedColour() {
  return themed(colours::kMutedText);
}

}  // namespace

ColourLegend::ColourLegend(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("colourLegend"));
  setCursor(Qt::SizeAllCursor);
  const QPointF kept = QSettings().value(kPlace, QPointF(0.0, 1.0)).toPointF();
  share_ = {std::clamp(kept.x(), 0.0, 1.0), std::clamp(kept.y(), 0.0, 1.0)};
  resize(sizeHint());
}

QPoint ColourLegend::room() const {
  const QSize spare = parentWidget()->size() - size() - QSize(2 * kMargin, 2 * kMargin);
  return {std::max(spare.width(), 0), std::max(spare.height(), 0)};
}

void ColourLegend::place() {
  if (grabbed_) return;
  const QPoint most = room();
  move(kMargin + qRound(share_.x() * most.x()), kMargin + qRound(share_.y() * most.y()));
}

void ColourLegend::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return event->ignore();
  grabbed_ = event->pos();
}

void ColourLegend::mouseMoveEvent(QMouseEvent* event) {
  if (!grabbed_) return event->ignore();
  const QPoint most = room(), wanted = mapToParent(event->pos() - *grabbed_) - QPoint(kMargin, kMargin);
  const QPoint at(std::clamp(wanted.x(), 0, most.x()), std::clamp(wanted.y(), 0, most.y()));
  move(at + QPoint(kMargin, kMargin));
  share_ = {most.x() > 0 ? static_cast<double>(at.x()) / most.x() : 0.0,
            most.y() > 0 ? static_cast<double>(at.y()) / most.y() : 0.0};
}

void ColourLegend::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !grabbed_) return event->ignore();
  grabbed_.reset();
  QSettings().setValue(kPlace, share_);
}

void ColourLegend::setColourRange(double range) {
  if (range == range_) return;
  range_ = range;
  update();
}

void ColourLegend::showSnapshot(const ServoSnapshot& snapshot) {
  force_ = formatForce(glm::length(snapshot.wrench.force));
  torque_ = formatTorque(glm::length(snapshot.wrench.torque));
  contacts_ = QString::number(snapshot.contactCount);
  lead_ = formatLead(handLeadOf(snapshot));
  hasProxy_ = snapshot.mode == HapticMode::Proxy;
  resize(sizeHint());
  update();
}

void ColourLegend::setPast(bool isPast) {
  if (isPast == isPast_) return;
  isPast_ = isPast;
  update();
}

QSize ColourLegend::sizeHint() const {
  const int rows = hasProxy_ ? 4 : 2;
  return scale() * QSize(kLegendWidth, kFirstRow + (rows - 1) * kRowHeight + kBelowLastRow);
}

double ColourLegend::scale() const {
  return fontScale(*this);
}

QFont ColourLegend::letters() const {
  QFont letters = font();
  letters.setPixelSize(std::max(1, static_cast<int>(std::lround(QFontInfo(font()).pixelSize() / scale()))));
  return letters;
}

void ColourLegend::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.scale(scale(), scale());
  painter.setFont(letters());
  painter.setPen(QPen(isThemeDark() ? QColor(255, 255, 255, 40) : QColor(0, 0, 0, 36), 1.0));
  painter.setBrush(isThemeDark() ? QColor(32, 38, 44, 228) : QColor(255, 255, 255, 228));
  painter.drawRoundedRect(QRectF(QPointF(), QSizeF(size()) / scale()).adjusted(0.5, 0.5, -0.5, -0.5), 7.0,
                          7.0);
  paintScale(painter);
  if (isPast_) painter.setOpacity(isThemeDark() ? kPastOpacityOnDark : kPastOpacity);
  int y = kFirstRow;
  paintArrow(painter, y, colours::kForce);
  paintRow(painter, y, tr("Force"), force_);
  y += kRowHeight;
  paintArrow(painter, y, colours::kTorque);
  paintRow(painter, y, tr("Torque"), torque_);
  if (!hasProxy_) return;
  y += kRowHeight;
  paintDisc(painter, y);
  paintRow(painter, y, tr("Contacts"), contacts_);
  y += kRowHeight;
  paintGhost(painter, y);
  paintRow(painter, y, tr("Hand"), lead_);
}

void ColourLegend::paintScale(QPainter& painter) {
  QFont bold = letters();
  bold.setBold(true);
  painter.setFont(bold);
  painter.setPen(textColour());
  painter.drawText(kInset, 23, tr("Local minimum distance"));
  painter.setFont(letters());

  const QRectF bar(kInset, kBarTop, kLegendWidth - 2 * kInset, kBarHeight);
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  constexpr int kSteps = 16;
  for (int i = 0; i <= kSteps; ++i) {
    const double fraction = static_cast<double>(i) / kSteps;
    gradient.setColorAt(fraction, distanceColour(fraction));
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(gradient);
  painter.drawRoundedRect(bar, 2.5, 2.5);

  painter.setPen(mutedColour());
  const QRect labels(kInset, kBarTop + kBarHeight + 3, kLegendWidth - 2 * kInset, 18);
  painter.drawText(labels, Qt::AlignLeft, tr("contact"));
  painter.drawText(labels, Qt::AlignHCenter, formatLength(0.5 * range_));
  painter.drawText(labels, Qt::AlignRight, formatLength(range_));
}

void ColourLegend::paintRow(QPainter& painter, int y, const QString& name, const QString& value) {
  painter.setPen(textColour());
  painter.drawText(kInset + 34, y, name);
  painter.drawText(QRect(kInset, y - 13, kLegendWidth - 2 * kInset, 18), Qt::AlignRight | Qt::AlignVCenter,
                   value);
}

}  // namespace nearfit::ui
