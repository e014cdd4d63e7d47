#include "ui/tools/placing/align_bar.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>

#include "ui/widgets/elided_label.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr double kFarthestOffset = 1e3;  ///< [m]

}  // namespace

AlignBar::AlignBar(QWidget* view)
    : ViewBar(view, QStringLiteral("alignBar")),
      prompt_(new ElidedLabel(this)),
      hint_(new ElidedLabel(this)),
      filter_(new QComboBox(this)),
      flip_(new QCheckBox(tr("&Flip"), this)),
      offsetLabel_(new QLabel(tr("Distance"), this)),
      offset_(new NumberField(this)),
      keep_(new QCheckBox(tr("&Keep"), this)),
      apply_(new QPushButton(tr("Apply"), this)),
      cancel_(new QPushButton(tr("Cancel"), this)) {
  setUpFields();
  auto* fields = new QHBoxLayout;
  fields->setSpacing(8);
  for (QWidget* widget :
       {static_cast<QWidget*>(filter_), static_cast<QWidget*>(flip_), static_cast<QWidget*>(offsetLabel_),
        static_cast<QWidget*>(offset_), static_cast<QWidget*>(keep_)}) {
    fields->addWidget(widget);
    // The row keeps one height, whichever of them are shown.
    fields->addStrut(widget->sizeHint().height());
  }
  fields->addStretch();
  for (QPushButton* button : {apply_, cancel_})
    fields->addWidget(button);
  auto* rows = new QVBoxLayout(this);
  rows->setContentsMargins(14, 6, 12, 6);
  rows->setSpacing(3);
  rows->addWidget(prompt_);
  rows->addWidget(hint_);
  rows->addLayout(fields);
}

void AlignBar::setUpFields() {
  prompt_->setObjectName(QStringLiteral("alignPrompt"));
  prompt_->setStyleSheet(QStringLiteral("font-weight: bold"));
  hint_->setObjectName(QStringLiteral("alignHint"));
  colourHint(colours::kMutedText);
  filter_->setObjectName(QStringLiteral("alignFilter"));
  filter_->setAccessibleName(tr("What can be picked"));
  filter_->setToolTip(tr("What can be picked; corners and edges within a few pixels of the pointer"));
  filter_->addItem(tr("Anything"), static_cast<int>(FeatureFilter::Any));
  filter_->addItem(tr("Flat faces"), static_cast<int>(FeatureFilter::Faces));
  filter_->addItem(tr("Axes and edges"), static_cast<int>(FeatureFilter::Axes));
  filter_->addItem(tr("Points"), static_cast<int>(FeatureFilter::Points));
  flip_->setObjectName(QStringLiteral("alignFlip"));
  flip_->setToolTip(tr("Turn the part around: faces point the same way, or axes run in opposite directions"));
  offsetLabel_->setBuddy(offset_);
  offset_->setObjectName(QStringLiteral("alignOffset"));
  offset_->setAccessibleName(tr("Distance"));
  offset_->setLength(4);
  offset_->setQuantityRange(-kFarthestOffset, kFarthestOffset);
  offset_->setQuantityStep(1e-3);
  offset_->setToolTip(tr("Distance between the two, outward from the target"));
  keep_->setObjectName(QStringLiteral("alignKeep"));
  keep_->setToolTip(tr("Make a joint that keeps the part there: on the axis, in the plane or at the point"));
  apply_->setObjectName(QStringLiteral("alignApply"));
  apply_->setToolTip(tr("Move the part there, as one undo step (Enter)"));
  cancel_->setObjectName(QStringLiteral("alignCancel"));
  cancel_->setToolTip(tr("Cancel without moving anything (Esc)"));
  connect(filter_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this] { emit filterChosen(filter()); });
  for (const QCheckBox* box : {flip_, keep_})
    connect(box, &QCheckBox::toggled, this, &AlignBar::optionsEdited);
  connect(offset_, &NumberField::quantityEdited, this, &AlignBar::optionsEdited);
  connect(apply_, &QPushButton::clicked, this, [this] {
    offset_->settle();
    if (!offset_->isFaulty()) emit applied();
  });
  connect(cancel_, &QPushButton::clicked, this, &AlignBar::cancelled);
}

void AlignBar::showPrompt(const QString& prompt, const QString& hint) {
  prompt_->setText(prompt);
  prompt_->setToolTip(prompt);
  hint_->setText(hint.isEmpty() ? QStringLiteral(" ") : hint);
  hint_->setToolTip(hint);
  place();
}

void AlignBar::colourHint(const QColor& colour) {
  hint_->setStyleSheet(QStringLiteral("color: %1").arg(colour.name()));
}

void AlignBar::showPair(const std::optional<Options>& options) {
  const Options shown = options.value_or(Options{});
  flip_->setVisible(shown.canFlip);
  offsetLabel_->setVisible(shown.canOffset);
  offset_->setVisible(shown.canOffset);
  keep_->setVisible(shown.canKeep);
  apply_->setEnabled(options.has_value());
  colourHint(colours::kMutedText);
  place();
}

void AlignBar::setApplicable(bool isApplicable) {
  // The hint says why not.
  colourHint(isApplicable ? colours::kMutedText : colours::kWarning);
  apply_->setEnabled(isApplicable);
}

void AlignBar::reset(bool hasFilter) {
  for (QCheckBox* box : {flip_, keep_}) {
    const QSignalBlocker blocker(box);
    box->setChecked(false);
  }
  offset_->takeBack();
  offset_->showQuantity(0.0);
  filter_->setVisible(hasFilter);
  showPair({});
}

FeatureFilter AlignBar::filter() const {
  return static_cast<FeatureFilter>(filter_->currentData().toInt());
}

bool AlignBar::isFlipped() const {
  return flip_->isChecked() && !flip_->isHidden();
}

bool AlignBar::isKept() const {
  return keep_->isChecked() && !keep_->isHidden();
}

double AlignBar::offset() const {
  return offset_->quantity();
}

}  // namespace nearfit::ui
