#include "ui/files/recent_files.h"

#include <QAction>
#include <QDir>
#include <QFileInfo>
#include <QMenu>
#include <QSettings>

#include "ui/widgets/names.h"

namespace nearfit::ui {
namespace {

const QString kKey = QStringLiteral("files/recent");

QString shown(const QString& file, int number) {
  QString name = shortName(QFileInfo(file).fileName());
  name.replace(QChar('&'), QStringLiteral("&&"));
  const QString entry = QFileInfo::exists(file) ? name : QObject::tr("%1 (missing)").arg(name);
  return number < 10 ? QStringLiteral("&%1  %2").arg(QString::number(number), entry) : entry;
}

}  // namespace

RecentFiles::RecentFiles(QMenu* menu, QObject* parent) : QObject(parent), menu_(menu) {
  connect(menu_, &QMenu::aboutToShow, this, &RecentFiles::fill);
  menu_->setToolTipsVisible(true);
  fill();
}

QStringList RecentFiles::list() {
  return QStringList(QSettings().value(kKey).toStringList().mid(0, kMax));
}

void RecentFiles::remember(const QString& file) {
  const QString path = QDir::cleanPath(QFileInfo(file).absoluteFilePath());
  QStringList files = list();
  files.removeAll(path);
  files.prepend(path);
  QSettings().setValue(kKey, QStringList(files.mid(0, kMax)));
}

void RecentFiles::forget(const QString& file) {
  QStringList files = list();
  files.removeAll(file);
  QSettings().setValue(kKey, files);
}

void RecentFiles::fill() {
  menu_->clear();
  int number = 0;
  for (const QString& file : list()) {
    QAction* action = menu_->addAction(shown(file, ++number));
    action->setToolTip(QDir::toNativeSeparators(file));
    action->setStatusTip(action->toolTip());
    connect(action, &QAction::triggered, this, [this, file] { open(file); });
  }
  if (number == 0) menu_->addAction(tr("No recent scenes"))->setEnabled(false);
  menu_->addSeparator();
  QAction* clear = menu_->addAction(tr("&Clear list"));
  clear->setObjectName(QStringLiteral("clearRecent"));
  clear->setToolTip(tr("Clear the list of recent scenes; the files stay"));
  clear->setEnabled(number > 0);
  connect(clear, &QAction::triggered, this, [] { QSettings().remove(kKey); });
}

void RecentFiles::open(const QString& file) {
  if (QFileInfo::exists(file)) {
    emit openRequested(file);
    return;
  }
  forget(file);
  emit missing(file);
}

}  // namespace nearfit::ui
