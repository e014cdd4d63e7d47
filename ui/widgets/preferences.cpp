#include "ui/widgets/preferences.h"

#include <QDir>
#include <QFileInfo>
#include <QSettings>
#include <QStandardPaths>
#include <cmath>

#include "core/base/error.h"

namespace nearfit::ui {
namespace {

QVariant value(const char* key, const QVariant& fallback = {}) {
  return QSettings().value(QLatin1String(key), fallback);
}

void setValue(const char* key, const QVariant& value) {
  QSettings().setValue(QLatin1String(key), value);
}

}  // namespace

QString Preferences::lastFolder() {
  const QString last = value("files/folder").toString();
  if (QFileInfo(last).isDir()) return last;
  const QString documents = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
  return QFileInfo(documents).isDir() ? documents : QDir::homePath();
}

void Preferences::rememberFolderOf(const QString& file) {
  setValue("files/folder", QFileInfo(file).absolutePath());
}

RateSettings Preferences::rate() {
  const RateSettings usual;
  RateSettings kept;
  kept.deadZone = value("spaceMouse/deadZone", usual.deadZone).toDouble();
  kept.exponent = value("spaceMouse/curve", usual.exponent).toDouble();
  kept.fullSpeed = value("spaceMouse/speed", usual.fullSpeed).toDouble();
  kept.fullTurn = value("spaceMouse/turnSpeed", usual.fullTurn).toDouble();
  const QStringList off = value("spaceMouse/off").toStringList();
  const QStringList reversed = value("spaceMouse/reversed").toStringList();
  for (std::size_t i = 0; i < kRateAxes.size(); ++i) {
    kept.isEnabled[i] = !off.contains(QLatin1String(kRateAxes[i]));
    kept.isInverted[i] = reversed.contains(QLatin1String(kRateAxes[i]));
  }
  try {
    checkRateSettings(kept);
  } catch (const UsageError&) {
    return usual;  // Someone has edited the file.
  }
  return kept;
}

void Preferences::setRate(const RateSettings& settings) {
  QStringList off, reversed;
  for (std::size_t i = 0; i < kRateAxes.size(); ++i) {
    if (!settings.isEnabled[i]) off << QLatin1String(kRateAxes[i]);
    if (settings.isInverted[i]) reversed << QLatin1String(kRateAxes[i]);
  }
  setValue("spaceMouse/deadZone", settings.deadZone);
  setValue("spaceMouse/curve", settings.exponent);
  setValue("spaceMouse/speed", settings.fullSpeed);
  setValue("spaceMouse/turnSpeed", settings.fullTurn);
  setValue("spaceMouse/off", off);
  setValue("spaceMouse/reversed", reversed);
}

QString Preferences::hand() {
  return value("feel/hand").toString();
}

void Preferences::setHand(const QString& hand) {
  setValue("feel/hand", hand);
}

LengthUnit Preferences::lengthUnit() {
  const QString kept = value("view/lengthUnit").toString();
  for (const LengthUnit unit : kLengthUnits) {
    if (symbolOf(unit) == kept) return unit;
  }
  return LengthUnit::Millimetre;
}

void Preferences::setLengthUnit(LengthUnit unit) {
  setValue("view/lengthUnit", symbolOf(unit));
}

double Preferences::clearanceRange() {
  const double range = value("clearanceMap/range", 0.0).toDouble();
  return std::isfinite(range) && range > 0.0 ? range : 0.0;
}

void Preferences::setClearanceRange(double range) {
  setValue("clearanceMap/range", range);
}

bool Preferences::hasNearClearances() {
  return value("clearanceMap/nearParts", false).toBool();
}

void Preferences::setNearClearances(bool hasNearParts) {
  setValue("clearanceMap/nearParts", hasNearParts);
}

double Preferences::checkThreshold() {
  constexpr double kFirst = 1e-3;
  bool isNumber = false;
  const double kept = value("sceneCheck/threshold").toDouble(&isNumber);
  return isNumber && kept >= 0.0 && kept <= kMaxCheckThreshold ? kept : kFirst;
}

void Preferences::setCheckThreshold(double threshold) {
  setValue("sceneCheck/threshold", threshold);
}

bool Preferences::isOrthographic() {
  return value("view/orthographic", false).toBool();
}

void Preferences::setOrthographic(bool isOrthographic) {
  setValue("view/orthographic", isOrthographic);
}

bool Preferences::hasScaleBar() {
  return value("view/scaleBar", true).toBool();
}

void Preferences::setScaleBar(bool hasScaleBar) {
  setValue("view/scaleBar", hasScaleBar);
}

bool Preferences::takeFirstRun() {
  if (value("window/hasRun", false).toBool()) return false;
  setValue("window/hasRun", true);
  // Older versions stored the geometry, but not hasRun.
  return windowGeometry().isEmpty();
}

QByteArray Preferences::windowGeometry() {
  return value("window/geometry").toByteArray();
}

void Preferences::setWindowGeometry(const QByteArray& geometry) {
  setValue("window/geometry", geometry);
}

}  // namespace nearfit::ui
