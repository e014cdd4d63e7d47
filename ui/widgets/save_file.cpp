#include "ui/widgets/save_file.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QPushButton>
#include <algorithm>

namespace nearfit::ui {
namespace {

bool mayReplace(const QString& file, QWidget* parent) {
  QMessageBox box(QMessageBox::Warning, QObject::tr("Replace the file?"),
                  QObject::tr("%1 already exists. Replace it?").arg(QFileInfo(file).fileName()),
                  QMessageBox::Cancel, parent);
  box.setObjectName(QStringLiteral("replaceFile"));
  QPushButton* replace = box.addButton(QObject::tr("Replace"), QMessageBox::DestructiveRole);
  box.exec();
  return box.clickedButton() == replace;
}

}  // namespace

std::optional<QString> askForSave(const SaveRequest& request, QWidget* parent) {
  QFileDialog dialog(parent, request.title, request.start);
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setNameFilters(request.filters);
  while (dialog.exec() == QDialog::Accepted) {
    // QFileDialog itself takes whatever follows the last dot for the suffix.
    QString named = dialog.selectedFiles().first();
    const bool hasSuffix = request.suffixes.contains(QFileInfo(named).suffix(), Qt::CaseInsensitive);
    if (hasSuffix) return named;
    const auto kind = request.filters.indexOf(dialog.selectedNameFilter());
    const auto last = request.suffixes.size() - 1;
    QString file = named;
    if (!file.endsWith('.')) file += QChar('.');
    file += request.suffixes.at(std::clamp<decltype(kind)>(kind, 0, last));
    // The dialog has not asked about this name.
    if (!QFileInfo::exists(file) || mayReplace(file, parent)) return file;
  }
  return std::nullopt;
}

}  // namespace nearfit::ui
