#include "ui/view3d/drag_readout.h"

#include <QStringList>
#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "ui/widgets/format.h"

namespace nearfit::ui {
namespace {

constexpr QChar kMinus(0x2212);
constexpr int kBeside = 18;  ///< Distance from the pointer [pixels].
constexpr int kMaxDecimals = 6;

QString signedNumber(double value, int decimals) {
  const bool isZero = QString::number(value, 'f', decimals).toDouble() == 0.0;
  const QString sign = isZero ? QString() : value < 0.0 ? QString(kMinus) : QStringLiteral("+");
  return sign + formatFixed(std::abs(value), decimals);
}

}  // namespace

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
