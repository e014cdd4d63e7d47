#include "ui/panels/feel/preset_name_dialog.h"

#include <QDialogButtonBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/widgets/theme.h"

namespace nearfit::ui {

PresetNameDialog::PresetNameDialog(const QString& title, const QString& button, QWidget* parent)
    : QDialog(parent), name_(new QLineEdit(this)), note_(new QLabel(this)) {
  setObjectName(QStringLiteral("presetNameDialog"));
  setWindowTitle(title);
  auto* label = new QLabel(tr("&Name of the preset"), this);
  label->setBuddy(name_);
  name_->setObjectName(QStringLiteral("presetName"));
  note_->setObjectName(QStringLiteral("presetNameNote"));
  note_->setWordWrap(true);
  note_->setMinimumHeight(2 * note_->fontMetrics().lineSpacing());
  note_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  note_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kWarning.name()));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  accept_ = buttons->button(QDialogButtonBox::Ok);
  accept_->setText(button);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(name_, &QLineEdit::textChanged, this, &PresetNameDialog::look);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(label);
  layout->addWidget(name_);
  layout->addWidget(note_);
  layout->addWidget(buttons);
  setMinimumWidth(360);
}

QString PresetNameDialog::ask(const QString& proposal, const Judge& judge) {
  judge_ = judge;
  name_->setText(proposal);
  name_->selectAll();
  look();
  return exec() == QDialog::Accepted ? name_->text().trimmed() : QString();
}

void PresetNameDialog::look() {
  const QString name = name_->text().trimmed();
  const Verdict verdict = judge_(name);
  accept_->setEnabled(!name.isEmpty() && !verdict.isRefused);
  note_->setText(name.isEmpty() ? QString() : verdict.note);
}

}  // namespace nearfit::ui
