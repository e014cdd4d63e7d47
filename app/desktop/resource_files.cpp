#include "app/desktop/resource_files.h"

#include <QCoreApplication>
#include <QDir>
#include <QFileInfo>

namespace nearfit::desktop {

QString resourceFile(const QString& name) {
  const QString installed = QCoreApplication::applicationDirPath() + QStringLiteral("/../share/nearfit");
  for (const QString& folder : {installed, QStringLiteral(NEARFIT_RESOURCE_DIR)}) {
    const QString file = QDir::cleanPath(QDir(folder).filePath(name));
    if (QFileInfo(file).isFile()) return file;
  }
  return {};
}

}  // namespace nearfit::desktop
