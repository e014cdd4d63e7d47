#include "ui/panels/suggest/suggestion_card.h"

#include <QDialogButtonBox>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/widgets/font_scale.h"
#include "ui/widgets/names.h"

namespace nearfit::ui {

SuggestionCard::SuggestionCard(const QString& text, bool isFound, QWidget* parent) : QDialog(parent) {
  setObjectName(QStringLiteral("suggestionCard"));
  setWindowTitle(isFound ? tr("Suggested path") : tr("No path found"));
  setAttribute(Qt::WA_DeleteOnClose);
  auto* label = new QLabel(breakable(text), this);
  label->setObjectName(QStringLiteral("suggestionText"));
  label->setTextFormat(Qt::PlainText);
  label->setWordWrap(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, this);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::close);
  if (isFound) {
    auto* save = buttons->addButton(tr("&Save path…"), QDialogButtonBox::ActionRole);
    save->setObjectName(QStringLiteral("suggestionSave"));
    save->setToolTip(tr("Save the path to a file, which nearfit-cli certify proves anew"));
    save->setAutoDefault(false);
    connect(save, &QPushButton::clicked, this, &SuggestionCard::saveWanted);
    certificate_ = buttons->addButton(tr("Save ce&rtificate…"), QDialogButtonBox::ActionRole);
    certificate_->setObjectName(QStringLiteral("suggestionCertificate"));
    certificate_->setToolTip(
        tr("Save the proof as a file that nearfit-cli verify proves anew; a change of the scene ends it"));
    certificate_->setAutoDefault(false);
    connect(certificate_, &QPushButton::clicked, this, &SuggestionCard::certificateWanted);
    auto* feel = buttons->addButton(tr("&Feel it"), QDialogButtonBox::ActionRole);
    feel->setObjectName(QStringLiteral("suggestionFeel"));
    feel->setCheckable(true);
    feel->setAutoDefault(false);
    feel->setToolTip(tr("Draw the hand weakly toward the path; it can leave at any time"));
    connect(feel, &QPushButton::toggled, this, &SuggestionCard::guidanceWanted);
  }
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(label);
  layout->addWidget(buttons);
  setMinimumWidth(forFont(*this, 380));
}

void SuggestionCard::setCertifiable(bool isIt) {
  if (certificate_ != nullptr) certificate_->setEnabled(isIt);
}

}  // namespace nearfit::ui
