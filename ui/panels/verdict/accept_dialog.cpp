#include "ui/panels/verdict/accept_dialog.h"

#include <QDialog>
#include <QDialogButtonBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QVBoxLayout>
#include <cstddef>

#include "core/scene/pair_record.h"
#include "ui/widgets/font_scale.h"

namespace nearfit::ui {

std::optional<QString> askForReason(int count, const QString& offered, QWidget* parent) {
  QDialog dialog(parent);
  dialog.setObjectName(QStringLiteral("acceptDialog"));
  dialog.setWindowTitle(QObject::tr("Accept"));
  dialog.setMinimumWidth(forFont(dialog, 360));
  auto* label = new QLabel(count == 1 ? QObject::tr("&Why may this finding stay?")
                                      : QObject::tr("&Why may these %1 findings stay?").arg(count),
                           &dialog);
  auto* reason = new QLineEdit(offered, &dialog);
  reason->setObjectName(QStringLiteral("acceptReason"));
  // The limit is in bytes, and letters have one or more of them.
  reason->setMaxLength(static_cast<int>(kMaxReasonBytes));
  label->setBuddy(reason);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, &dialog);
  QPushButton* accept = buttons->button(QDialogButtonBox::Ok);
  accept->setText(QObject::tr("Accept"));
  const auto follow = [accept](const QString& text) {
    const QString said = text.trimmed();
    accept->setEnabled(!said.isEmpty() && static_cast<std::size_t>(said.toUtf8().size()) <= kMaxReasonBytes);
  };
  QObject::connect(reason, &QLineEdit::textChanged, accept, follow);
  QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
  QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
  auto* layout = new QVBoxLayout(&dialog);
  layout->addWidget(label);
  layout->addWidget(reason);
  layout->addWidget(buttons);
  follow(offered);
  reason->selectAll();
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;
  return reason->text().trimmed();
}

}  // namespace nearfit::ui
