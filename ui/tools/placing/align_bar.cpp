#include "ui/tools/placing/align_bar.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>

#include "ui/widgets/number_field.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr double kFarthest = 1e3;  ///< [m]

}  // namespace

AlignBar::AlignBar(QWidget* view)
    : ViewBar(view, QStringLiteral("alignBar")),
      prompt_(new QLabel(this)),
      hint_(new QLabel(this)),
      filter_(new QComboBox(this)),
      flip_(new QCheckBox(tr("&Flip"), this)),
      offsetLabel_(new QLabel(tr("Distance"), this)),
      offset_(new NumberField(this)),
      apply_(new QPushButton(tr("Apply"), this)),
      cancel_(new QPushButton(tr("Cancel"), this)) {
  setUpFields();
  auto* fields = new QHBoxLayout;
  fields->setSpacing(8);
  for (QWidget* widget :
       {static_cast<QWidget*>(filter_), static_cast<QWidget*>(flip_), static_cast<QWidget*>(offsetLabel_),
        static_cast<QWidget*>(offset_), static_cast<QWidget*>(apply_), static_cast<QWidget*>(cancel_)})
    fields->addWidget(widget);
  fields->insertStretch(4);
  auto* rows = new QVBoxLayout(this);
  rows->setContentsMargins(14, 8, 12, 10);
  rows->setSpacing(3);
  rows->addWidget(prompt_);
  rows->addWidget(hint_);
  rows->addLayout(fields);
}

void AlignBar::setUpFields() {
  prompt_->setObjectName(QStringLiteral("alignPrompt"));
  prompt_->setStyleSheet(QStringLiteral("font-weight: bold"));
  hint_->setObjectName(QStringLiteral("alignHint"));
  hint_->setMinimumWidth(430);
  hint_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  filter_->setObjectName(QStringLiteral("alignFilter"));
  filter_->setAccessibleName(tr("What can be picked"));
  filter_->setToolTip(tr("What can be picked; corners and edges within a few pixels of the pointer"));
  filter_->addItem(tr("Anything"), static_cast<int>(FeatureFilter::Any));
  filter_->addItem(tr("Flat faces"), static_cast<int>(FeatureFilter::Faces));
  filter_->addItem(tr("Axes and edges"), static_cast<int>(FeatureFilter::Axes));
  filter_->addItem(tr("Points"), static_cast<int>(FeatureFilter::Points));
  flip_->setObjectName(QStringLiteral("alignFlip"));
  flip_->setToolTip(
      tr("Turn the part round, so that the faces point the same way or the axes run in opposite directions"));
  offsetLabel_->setBuddy(offset_);
  offset_->setObjectName(QStringLiteral("alignOffset"));
  offset_->setAccessibleName(tr("Distance"));
  offset_->setLength(4);
  offset_->setQuantityRange(-kFarthest, kFarthest);
  offset_->setQuantityStep(1e-3);
  offset_->setToolTip(tr("Distance between the two, outward from the one that stays"));
  apply_->setObjectName(QStringLiteral("alignApply"));
  apply_->setToolTip(tr("Move the part there, as one undo step (Return)"));
  cancel_->setObjectName(QStringLiteral("alignCancel"));
  cancel_->setToolTip(tr("Leave everything as it was (Escape)"));
  connect(filter_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this] { emit filterChosen(filter()); });
  connect(flip_, &QCheckBox::toggled, this, &AlignBar::optionsEdited);
  connect(offset_, &NumberField::quantityEdited, this, &AlignBar::optionsEdited);
  connect(apply_, &QPushButton::clicked, this, [this] {
    offset_->settle();
    if (!offset_->isFaulty()) emit applied();
  });
  connect(cancel_, &QPushButton::clicked, this, &AlignBar::cancelled);
}

void AlignBar::showPrompt(const QString& prompt, const QString& hint) {
  prompt_->setText(prompt);
  hint_->setText(hint.isEmpty() ? QStringLiteral(" ") : hint);
  place();
}

void AlignBar::showPair(bool isPicked, bool canFlip, bool canOffset) {
  flip_->setVisible(isPicked);
  flip_->setEnabled(canFlip);
  offsetLabel_->setVisible(isPicked && canOffset);
  offset_->setVisible(isPicked && canOffset);
  apply_->setEnabled(isPicked);
  place();
}

void AlignBar::reset() {
  const QSignalBlocker flipBlocker(flip_);
  flip_->setChecked(false);
  offset_->takeBack();
  offset_->showQuantity(0.0);
  showPair(false, false, false);
}

FeatureFilter AlignBar::filter() const {
  return static_cast<FeatureFilter>(filter_->currentData().toInt());
}

bool AlignBar::isFlipped() const {
  return flip_->isChecked() && flip_->isEnabled();
}

double AlignBar::offset() const {
  return offset_->quantity();
}

}  // namespace nearfit::ui
