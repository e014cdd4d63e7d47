#include "ui/widgets/length_unit.h"

#include <QObject>
#include <algorithm>
#include <cmath>

#include "ui/widgets/format.h"

namespace nearfit::ui {
namespace {

LengthUnit& shown() noexcept {
  static LengthUnit unit = LengthUnit::Millimetre;
  return unit;
}

}  // namespace

LengthUnit shownLengthUnit() noexcept {
  return shown();
}

void setShownLengthUnit(LengthUnit unit) noexcept {
  shown() = unit;
}

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

QString lengthIn(LengthUnit unit, double metres, int decimals) {
  const double inUnits = metres / metresOf(unit);
  // Avoids "-0".
  const bool isZero = QString::number(inUnits, 'f', decimals).toDouble() == 0.0;
  return formatFixed(isZero ? 0.0 : inUnits, decimals) + QChar(' ') + symbolOf(unit);
}

int measuredDecimals(LengthUnit unit, double metres) noexcept {
  constexpr int kMin = 3, kMax = 9;
  const double inUnits = std::abs(metres) / metresOf(unit);
  if (!(inUnits > 0.0)) return kMin;
  return std::clamp(4 - static_cast<int>(std::floor(std::log10(inUnits))), kMin, kMax);
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
