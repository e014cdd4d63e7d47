#include "ui/files/import_tessellation.h"

#include <QSettings>
#include <QString>

#include "core/base/error.h"
#include "core/scene/document_load.h"

namespace nearfit::ui {
namespace {

const QString kImportChord = QStringLiteral("import/chord"), kImportAngle = QStringLiteral("import/angle");

}  // namespace

Tessellation importTessellation() {
  const QSettings settings;
  const Tessellation kept{settings.value(kImportChord, 0.0).toDouble(),
                          settings.value(kImportAngle, 0.0).toDouble()};
  try {
    checkTessellation(kept);
  } catch (const UsageError&) {
    return {};  // Someone has edited the file.
  }
  return kept;
}

void setImportTessellation(const Tessellation& tessellation) {
  QSettings settings;
  settings.setValue(kImportChord, tessellation.chord);
  settings.setValue(kImportAngle, tessellation.angle);
}

}  // namespace nearfit::ui
