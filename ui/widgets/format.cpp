#include "ui/widgets/format.h"

#include <QCoreApplication>
#include <QLocale>
#include <QObject>
#include <QStringList>
#include <algorithm>
#include <cmath>

namespace nearfit::ui {
namespace {

constexpr QChar kMicro(0xB5);
constexpr QChar kDot(0xB7);
const QString kNoNumber = QStringLiteral("–");

/// Three figures or more from 1 up, two decimals below; no exponent.
QString figures(double value) {
  const double magnitude = std::abs(value);
  const int decimals = magnitude < 9.995 ? 2 : magnitude < 99.95 ? 1 : 0;
  return formatFixed(value, decimals);
}

/// Three figures below one too: 0.0484.
QString threeFigures(double value) {
  const double magnitude = std::abs(value);
  if (magnitude == 0.0 || magnitude >= 0.9995) return figures(value);
  const int zeros = static_cast<int>(std::floor(-std::log10(magnitude)));
  return formatFixed(value, zeros + 3);
}

/// A length in a unit that suits its size.
struct SizedLength {
  double number;
  QString symbol;
  bool isInChosenUnit;
};

SizedLength sizedLength(double metres, LengthUnit unit) {
  constexpr double kMicrons = 1e6;
  const double magnitude = std::abs(metres), number = metres / metresOf(unit);
  if (unit == LengthUnit::Millimetre && magnitude >= 1.0) return {metres, QStringLiteral("m"), false};
  const bool isInch = unit == LengthUnit::Inch;
  // Short: below 0.1 mm, or 0.001 in.
  const bool isShort = isInch ? std::abs(number) < 1e-3 : magnitude < 1e-4;
  if (isShort && magnitude > 0.0) {
    const QString symbol = QString(kMicro) + QLatin1String(isInch ? "in" : "m");
    return {kMicrons * (isInch ? number : metres), symbol, false};
  }
  return {number, symbolOf(unit), true};
}

}  // namespace

QString formatFixed(double value, int decimals) {
  QLocale locale;
  locale.setNumberOptions(QLocale::OmitGroupSeparator);
  return locale.toString(value, 'f', decimals);
}

QString formatLength(double metres) {
  return formatLength(metres, shownLengthUnit());
}

QString formatLength(double metres, LengthUnit unit) {
  if (!std::isfinite(metres)) return kNoNumber;
  const SizedLength sized = sizedLength(metres, unit);
  const bool isFine = sized.isInChosenUnit && unit != LengthUnit::Millimetre;
  return (isFine ? threeFigures(sized.number) : figures(sized.number)) + QChar(' ') + sized.symbol;
}

QString formatRoundLength(double metres) {
  if (!std::isfinite(metres)) return kNoNumber;
  const SizedLength sized = sizedLength(metres, shownLengthUnit());
  return formatNumber(sized.number) + QChar(' ') + sized.symbol;
}

QString formatExtent(const glm::dvec3& metres) {
  const double largest = std::max({std::abs(metres.x), std::abs(metres.y), std::abs(metres.z)});
  if (!std::isfinite(metres.x + metres.y + metres.z)) return kNoNumber;
  const SizedLength sized = sizedLength(largest, shownLengthUnit());
  const double perMetre = largest > 0.0 ? sized.number / largest : 0.0;
  QStringList numbers;
  for (const double length : {metres.x, metres.y, metres.z})
    numbers << formatNumber(length * perMetre);
  return numbers.join(QStringLiteral(" × ")) + QChar(' ') + sized.symbol;
}

QString formatDistance(double metres, bool isBound) {
  const QString length = formatLength(metres);
  return isBound && std::isfinite(metres) ? QCoreApplication::translate("format", "at least %1").arg(length)
                                          : length;
}

QString formatMinima(std::uint32_t count, bool isTruncated) {
  return QString::number(count) + (isTruncated ? QStringLiteral("+") : QString());
}

QString explainMinima(bool isTruncated) {
  return isTruncated
             ? QCoreApplication::translate("format", "There may be more: the search stopped at its limit.")
             : QString();
}

QString formatParts(std::size_t count) {
  return count == 1 ? QObject::tr("1 part") : QObject::tr("%1 parts").arg(count);
}

QString formatForce(double newtons) {
  return figures(newtons) + QStringLiteral(" N");
}

QString formatTorque(double newtonMetres) {
  const bool isSmall = std::abs(newtonMetres) < 1.0;
  const QString number = figures(isSmall ? newtonMetres * 1e3 : newtonMetres);
  return number + (isSmall ? QStringLiteral(" mN") : QStringLiteral(" N")) + kDot + QChar('m');
}

QString formatEnergy(double joules) {
  if (std::abs(joules) >= 1.0) return figures(joules) + QStringLiteral(" J");
  if (std::abs(joules) >= 1e-3 || joules == 0.0) return figures(joules * 1e3) + QStringLiteral(" mJ");
  return figures(joules * 1e6) + QChar(' ') + kMicro + QChar('J');
}

QString formatMass(double kilograms) {
  if (kilograms >= 1.0) return figures(kilograms) + QStringLiteral(" kg");
  if (kilograms >= 1e-3) return figures(kilograms * 1e3) + QStringLiteral(" g");
  if (kilograms >= 1e-7 || kilograms <= 0.0) return figures(kilograms * 1e6) + QStringLiteral(" mg");
  if (kilograms >= 1e-10) return figures(kilograms * 1e9) + QChar(' ') + kMicro + QChar('g');
  return figures(kilograms * 1e12) + QStringLiteral(" ng");
}

QString formatNumber(double value) {
  constexpr int kFigures = 4, kMaxDecimals = 12;
  if (!std::isfinite(value)) return kNoNumber;
  if (value == 0.0) return QStringLiteral("0");
  const int before = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  int decimals = std::clamp(kFigures - before, 0, kMaxDecimals);
  const QString digits = QString::number(value, 'f', decimals);
  for (int last = digits.size() - 1; decimals > 0 && digits[last] == QChar('0'); --last)
    --decimals;
  return formatFixed(value, decimals);
}

QString formatDuration(double seconds) {
  if (std::abs(seconds) >= 1.0) return figures(seconds) + QStringLiteral(" s");
  if (std::abs(seconds) >= 1e-3) return figures(seconds * 1e3) + QStringLiteral(" ms");
  return figures(seconds * 1e6) + QChar(' ') + kMicro + QChar('s');
}

}  // namespace nearfit::ui
