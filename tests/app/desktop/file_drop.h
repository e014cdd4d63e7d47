#pragma once

#include <QMimeData>
#include <filesystem>

#include "tests/app/desktop/desktop_driver.h"

namespace nearfit::test {

inline QString nameOf(const std::filesystem::path& file) {
  return QString::fromStdString(file.string());
}

/// Drops files on the window as a file manager does.
inline void drop(QWidget& window, const QStringList& files) {
  QMimeData data;
  QList<QUrl> urls;
  for (const QString& file : files)
    urls << QUrl::fromLocalFile(file);
  data.setUrls(urls);
  const QPoint middle = window.rect().center();
  QDragEnterEvent enter(middle, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&window, &enter);
  QVERIFY(enter.isAccepted());
  QDropEvent event(middle, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&window, &event);
}

}  // namespace nearfit::test
