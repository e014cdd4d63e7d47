#include "ui/preferences.h"

#include <QFileInfo>
#include <QSettings>

namespace nearfit::ui {
namespace {

constexpr double kMillimetre = 1e-3;

QVariant value(const char* key, const QVariant& fallback = {}) {
  return QSettings().value(QLatin1String(key), fallback);
}

void setValue(const char* key, const QVariant& value) {
  QSettings().setValue(QLatin1String(key), value);
}

}  // namespace

double Preferences::metresPerUnit() {
  bool isNumber = false;
  const double unit = value("mesh/metresPerUnit", kMillimetre).toDouble(&isNumber);
  return isNumber && unit > 0.0 ? unit : kMillimetre;
}

void Preferences::setMetresPerUnit(double metresPerUnit) {
  setValue("mesh/metresPerUnit", metresPerUnit);
}

QString Preferences::lastFolder() {
  return value("files/folder").toString();
}

void Preferences::rememberFolderOf(const QString& file) {
  setValue("files/folder", QFileInfo(file).absolutePath());
}

QByteArray Preferences::windowGeometry() {
  return value("window/geometry").toByteArray();
}

void Preferences::setWindowGeometry(const QByteArray& geometry) {
  setValue("window/geometry", geometry);
}

}  // namespace nearfit::ui
