#include "ui/format.h"

#include <cmath>

namespace nearfit::ui {
namespace {

constexpr QChar kMicro(0xB5);
constexpr QChar kDot(0xB7);

/// Three figures without an exponent.
QString figures(double value) {
  const double magnitude = std::abs(value);
  const int decimals = magnitude < 9.995 ? 2 : magnitude < 99.95 ? 1 : 0;
  return QString::number(value, 'f', decimals);
}

}  // namespace

QString formatLength(double metres) {
  if (!std::isfinite(metres)) return QStringLiteral("–");
  const double magnitude = std::abs(metres);
  if (magnitude >= 1.0) return figures(metres) + QStringLiteral(" m");
  if (magnitude >= 1e-4 || magnitude == 0.0) return figures(metres * 1e3) + QStringLiteral(" mm");
  return figures(metres * 1e6) + QChar(' ') + kMicro + QChar('m');
}

QString formatForce(double newtons) {
  return figures(newtons) + QStringLiteral(" N");
}

QString formatTorque(double newtonMetres) {
  const bool isSmall = std::abs(newtonMetres) < 1.0;
  const QString number = figures(isSmall ? newtonMetres * 1e3 : newtonMetres);
  return number + (isSmall ? QStringLiteral(" mN") : QStringLiteral(" N")) + kDot + QChar('m');
}

QString formatDuration(double seconds) {
  if (std::abs(seconds) >= 1.0) return figures(seconds) + QStringLiteral(" s");
  if (std::abs(seconds) >= 1e-3) return figures(seconds * 1e3) + QStringLiteral(" ms");
  return figures(seconds * 1e6) + QChar(' ') + kMicro + QChar('s');
}

}  // namespace nearfit::ui
