#include "ui/view3d/gizmo_overlay.h"

#include <QPolygonF>
#include <QStringList>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Margin around the figures, for line widths and rims [pixels].
constexpr int kGizmoRoom = 8;
constexpr double kLine = 3.0, kRing = 2.6, kFarSide = 1.5, kOutline = 1.5, kHotter = 1.4, kRim = 2.6;
constexpr double kSquareFill = 0.38, kHotFill = 0.75, kSteppedBack = 0.22, kRimOpacity = 0.8;
const QColor kHot(0xff, 0xa8, 0x00);

QPolygonF polygonOf(const std::vector<glm::dvec2>& points) {
  QPolygonF polygon;
  polygon.reserve(static_cast<int>(points.size()));
  for (const glm::dvec2& point : points)
    polygon << QPointF(point.x, point.y);
  return polygon;
}

QColor faded(QColor colour, double opacity) {
  colour.setAlphaF(std::clamp(opacity, 0.0, 1.0));
  return colour;
}

QPen penOf(const QColor& colour, double width) {
  return QPen(colour, width, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin);
}

constexpr QChar kMinus(0x2212);
constexpr int kBeside = 18;  ///< Distance from the pointer [pixels].
constexpr int kMaxDecimals = 6;

QString signedNumber(double value, int decimals) {
  const bool isZero = QString::number(value, 'f', decimals).toDouble() == 0.0;
  const QString sign = isZero ? QString() : value < 0.0 ? QString(kMinus) : QStringLiteral("+");
  return sign + formatFixed(std::abs(value), decimals);
}

}  // namespace

GizmoOverlay::GizmoOverlay(QWidget* view) : QWidget(view) {
  setObjectName(QStringLiteral("gizmo"));
  setAttribute(Qt::WA_TransparentForMouseEvents);
  hide();
}

void GizmoOverlay::showPicture(GizmoPicture picture) {
  if (picture.layout.figures().empty()) return clear();
  picture_ = std::move(picture);
  const QRect wanted = extent();
  if (wanted.isEmpty()) return clear();
  setGeometry(wanted);
  show();
  update();
}

void GizmoOverlay::clear() {
  picture_.reset();
  hide();
}

QRect GizmoOverlay::extent() const {
  QRectF box;
  for (const GizmoFigure& figure : picture_->layout.figures())
    box |= polygonOf(figure.points).boundingRect();
  if (picture_->guide) {
    for (const auto* line : {&picture_->guide->line, &picture_->guide->way, &picture_->guide->sector})
      box |= polygonOf(*line).boundingRect();
  }
  return box.toAlignedRect().adjusted(-kGizmoRoom, -kGizmoRoom, kGizmoRoom, kGizmoRoom) &
         parentWidget()->rect();
}

void GizmoOverlay::paintEvent(QPaintEvent*) {
  if (!picture_) return;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.translate(-pos());
  if (picture_->guide) paintGuide(painter, *picture_->guide, axisColour(axisOf(picture_->hot)));
  for (const GizmoFigure& figure : picture_->layout.figures())
    paintFigure(painter, figure);
}

void GizmoOverlay::paintFigure(QPainter& painter, const GizmoFigure& figure) const {
  const bool isHot = figure.handle == picture_->hot;
  const bool isMiddle = figure.handle == GizmoGrip::MoveFree;
  double opacity = figure.opacity;
  if (picture_->isDragging && !isHot) opacity *= kSteppedBack;
  const QColor colour = isHot ? kHot : axisColour(axisOf(figure.handle));
  const QPolygonF shape = polygonOf(figure.points);
  if (!figure.isArea) {
    const double width = figure.isFarSide        ? kFarSide
                         : isHot                 ? kHotter * kRing
                         : isRing(figure.handle) ? kRing
                                                 : kLine;
    if (!figure.isFarSide) {
      painter.setPen(penOf(faded(Qt::white, kRimOpacity * opacity), width + kRim));
      painter.drawPolyline(shape);
    }
    painter.setPen(penOf(faded(colour, opacity), width));
    painter.drawPolyline(shape);
    return;
  }
  const bool isSquare = isPlane(figure.handle);
  const QColor fill = isMiddle && !isHot ? QColor(Qt::white) : colour;
  painter.setPen(penOf(faded(Qt::white, kRimOpacity * opacity), kOutline + kRim));
  painter.setBrush(Qt::NoBrush);
  painter.drawPolygon(shape);
  painter.setPen(penOf(faded(isMiddle && isHot ? QColor(Qt::white) : colour, opacity), kOutline));
  painter.setBrush(faded(fill, opacity * (!isSquare ? 1.0 : isHot ? kHotFill : kSquareFill)));
  painter.drawPolygon(shape);
}

void GizmoOverlay::paintGuide(QPainter& painter, const GizmoGuide& guide, const QColor& colour) {
  if (!guide.line.empty()) {
    painter.setPen(penOf(faded(Qt::white, 0.5), 3.0));
    painter.drawPolyline(polygonOf(guide.line));
    painter.setPen(penOf(faded(colour, 0.75), 1.2));
    painter.drawPolyline(polygonOf(guide.line));
  }
  if (!guide.sector.empty()) {
    painter.setPen(penOf(faded(kHot, 0.9), 1.2));
    painter.setBrush(faded(kHot, 0.3));
    painter.drawPolygon(polygonOf(guide.sector));
  }
  if (guide.way.size() == 2) {
    QPen pen = penOf(kHot.darker(120), 1.6);
    pen.setStyle(Qt::DashLine);
    painter.setPen(pen);
    painter.setBrush(Qt::NoBrush);
    painter.drawPolyline(polygonOf(guide.way));
    painter.drawEllipse(QPointF(guide.way[0].x, guide.way[0].y), 4.0, 4.0);
  }
}

DragReadout::DragReadout(QWidget* view) : QLabel(view) {
  setObjectName(QStringLiteral("dragReadout"));
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setTextFormat(Qt::RichText);
  setStyleSheet(
      QStringLiteral("#dragReadout { background: rgba(28, 37, 46, 225); color: white; border-radius: 5px; "
                     "padding: 4px 8px; font-weight: 600; }"));
  hide();
}

void DragReadout::showAt(const QPoint& pointer, const QString& text, const QString& note) {
  QString rich = text.toHtmlEscaped();
  if (!note.isEmpty()) {
    rich += QStringLiteral("<br><span style='color:#ffc76b; font-weight:400'>%1</span>")
                .arg(note.toHtmlEscaped());
  }
  setText(rich);
  setAccessibleName(note.isEmpty() ? text : text + QStringLiteral(", ") + note);
  adjustSize();
  const QRect room = parentWidget()->rect();
  QPoint corner = pointer + QPoint(kBeside, kBeside);
  if (corner.x() + width() > room.width()) corner.setX(pointer.x() - kBeside - width());
  if (corner.y() + height() > room.height()) corner.setY(pointer.y() - kBeside - height());
  move(std::max(corner.x(), 0), std::max(corner.y(), 0));
  raise();
  show();
}

QString dragText(const GizmoDrag& drag, const glm::dvec3& shift, double angle, double pixel,
                 LengthUnit unit) {
  if (isRing(drag.handle())) {
    const double degrees = angle * 180.0 / std::numbers::pi;
    return signedNumber(degrees, 1) + QChar(0xB0);
  }
  // Down to about a tenth of a pixel.
  const double metres = metresOf(unit);
  const double pixelInUnits = std::max(pixel / metres, 1e-9);
  const int decimals =
      std::clamp(static_cast<int>(std::ceil(-std::log10(pixelInUnits))) + 1, 1, kMaxDecimals);
  QStringList parts;
  for (int axis = 0; axis < 3; ++axis) {
    const bool isAlong = isArrow(drag.handle())   ? axis == axisOf(drag.handle())
                         : isPlane(drag.handle()) ? axis != axisOf(drag.handle())
                                                  : true;
    if (!isAlong) continue;
    const double along = glm::dot(shift, drag.frame().axes[axis]) / metres;
    parts << QString(QChar('X' + axis)) + QChar(0xA0) + signedNumber(along, decimals);
  }
  return parts.join(QStringLiteral("   ")) + QChar(' ') + symbolOf(unit);
}

}  // namespace nearfit::ui
