#pragma once

#include <QComboBox>
#include <QRadioButton>

#include "tests/app/desktop/desktop_driver.h"
#include "ui/files/export/export_dialog.h"

namespace nearfit::test {

/// Chooses in the export dialog as a user does: a format by its row, selected parts by their button.
inline void chooseExport(int kindRow, bool isSelected, QString* summary = nullptr) {
  whenModal<ui::ExportDialog>([=](ui::ExportDialog* dialog) {
    auto* kind = dialog->findChild<QComboBox*>(QStringLiteral("exportKind"));
    kind->setFocus();
    QTest::keyClick(kind, Qt::Key_Home);
    for (int i = 0; i < kindRow; ++i)
      QTest::keyClick(kind, Qt::Key_Down);
    if (isSelected) {
      auto* chosen = dialog->findChild<QRadioButton*>(QStringLiteral("exportSelected"));
      QTest::mouseClick(chosen, Qt::LeftButton, {}, QPoint(8, chosen->height() / 2));
    }
    if (summary != nullptr) *summary = dialog->findChild<QLabel*>(QStringLiteral("exportSummary"))->text();
    QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save), Qt::LeftButton);
  });
}

}  // namespace nearfit::test
