#include "ui/length_unit.h"

#include <QObject>

namespace nearfit::ui {

QString symbolOf(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::Centimetre:
      return QStringLiteral("cm");
    case LengthUnit::Metre:
      return QStringLiteral("m");
    case LengthUnit::Inch:
      return QStringLiteral("in");
    default:
      return QStringLiteral("mm");
  }
}

QString nameOf(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::Centimetre:
      return QObject::tr("Centimetres");
    case LengthUnit::Metre:
      return QObject::tr("Metres");
    case LengthUnit::Inch:
      return QObject::tr("Inches");
    default:
      return QObject::tr("Millimetres");
  }
}

double metresOf(LengthUnit unit) noexcept {
  switch (unit) {
    case LengthUnit::Centimetre:
      return 1e-2;
    case LengthUnit::Metre:
      return 1.0;
    case LengthUnit::Inch:
      return 0.0254;
    default:
      return 1e-3;
  }
}

int extraDecimals(LengthUnit unit) noexcept {
  switch (unit) {
    case LengthUnit::Centimetre:
    case LengthUnit::Inch:
      return 1;
    case LengthUnit::Metre:
      return 3;
    default:
      return 0;
  }
}

}  // namespace nearfit::ui
