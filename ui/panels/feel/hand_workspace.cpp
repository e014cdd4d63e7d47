#include "ui/panels/feel/hand_workspace.h"

#include <QAction>
#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>

#include "core/scene/haptic_limits.h"
#include "ui/panels/feel/locks_page.h"
#include "ui/widgets/number_field.h"

namespace nearfit::ui {

HandWorkspace::HandWorkspace(QAction* clutch, QWidget* parent)
    : FeelPage(parent),
      scaleRow_(new QWidget(this)),
      clutch_(new QToolButton(this)),
      note_(addNote()),
      recorded_(addNote()),
      locks_(new LocksPage(QStringLiteral("panel-"), this)) {
  auto* heading = new QLabel(tr("Workspace"), this);
  heading->setStyleSheet(QStringLiteral("font-weight: bold; color: #3b4754; padding-top: 8px"));
  heading->setIndent(0);
  NumberField* scale = addNumber(
      {"panelScale", tr("Metres in the scene per metre of the device"), tr(" ×"), kMinScale, kMaxScale},
      [](HapticSettings& s) -> double& { return s.mapping.scale; });
  auto* scaleLabel = new QLabel(tr("Scale"), scaleRow_);
  scaleLabel->setBuddy(scale);
  auto* row = new QHBoxLayout(scaleRow_);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(scaleLabel);
  row->addWidget(scale, 1);
  clutch_->setObjectName(QStringLiteral("clutchButton"));
  clutch_->setDefaultAction(clutch);
  clutch_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  clutch_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  clutch_->setFocusPolicy(Qt::StrongFocus);
  note_->setObjectName(QStringLiteral("clutchNote"));
  recorded_->setObjectName(QStringLiteral("recordedNote"));
  recorded_->setText(tr("A recorded hand repeats its motion: scale and locks come from the recording."));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  for (QWidget* each :
       {static_cast<QWidget*>(heading), scaleRow_, static_cast<QWidget*>(clutch_),
        static_cast<QWidget*>(note_), static_cast<QWidget*>(recorded_), static_cast<QWidget*>(locks_)})
    layout->addWidget(each);
  connect(locks_, &FeelPage::edited, this, &HandWorkspace::change);
  showHand(Hand::Scripted);
  showUncalibrated(false);
  showClutched(false);
}

void HandWorkspace::showHand(Hand hand, bool isRecorded) {
  scaleRow_->setVisible(hand == Hand::Device && !isRecorded);
  locks_->setVisible(!isRecorded);
  recorded_->setVisible(isRecorded);
  clutch_->setVisible(hand == Hand::Device);
  setVisible(hand != Hand::Scripted);
}

void HandWorkspace::showClutched(bool isClutched) {
  if (note_->isHidden() == isClutched) note_->setVisible(isClutched);
}

void HandWorkspace::showUncalibrated(bool isUncalibrated) {
  note_->setText(isUncalibrated ? tr("The part stays until the device is calibrated: see above.")
                                : tr("The part stays: move the device to a comfortable position."));
}

void HandWorkspace::refresh() {
  locks_->showSettings(settings());
}

}  // namespace nearfit::ui
