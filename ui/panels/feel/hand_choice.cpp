#include "ui/panels/feel/hand_choice.h"

#include <QAbstractItemView>
#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QComboBox>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSignalBlocker>
#include <QStandardItemModel>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

#include "core/scene/haptic_limits.h"
#include "ui/panels/feel/locks_page.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Room for margins beside the icon and name of an item in the list [pixels]; the view's own size hint is too small.
constexpr int kRoomOfAnItem = 50;
constexpr int kDeviceRole = Qt::UserRole + 1, kNoteRole = Qt::UserRole + 2;
/// The scripted hand, the manual hand and the recording are always there.
constexpr int kScripted = 0, kManual = 1, kRecording = 2, kFirstDevice = 3;
/// How the choice is remembered; a device by its name, since its id depends on the port.
const QString kScriptedHand = QStringLiteral("scripted"), kManualHand = QStringLiteral("manual"),
              kDeviceHand = QStringLiteral("device:");
/// Prefix of a recording's id.
const QString kReplay = QStringLiteral("replay:");
constexpr int kOpeningSteps = 1000;

}  // namespace

DeviceNotices::DeviceNotices(QWidget* parent)
    : QWidget(parent),
      none_(new QLabel(this)),
      text_(new QLabel(this)),
      copy_(new QPushButton(tr("Copy the command"), this)) {
  none_->setObjectName(QStringLiteral("noDevice"));
  none_->setWordWrap(true);
  none_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  text_->setObjectName(QStringLiteral("deviceNotices"));
  text_->setWordWrap(true);
  // A long path has no spaces to break at: the panel must not grow with it.
  text_->setTextFormat(Qt::PlainText);
  text_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  text_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kWarning.name()));
  copy_->setObjectName(QStringLiteral("copyCommand"));
  copy_->setToolTip(tr("Copy the command, run it in a terminal, then plug the device in again"));
  connect(copy_, &QPushButton::clicked, this, [this] { QApplication::clipboard()->setText(command_); });
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(none_);
  layout->addWidget(text_);
  layout->addWidget(copy_);
  showDevices({});
}

void DeviceNotices::showDevices(const QVector<DeviceChoice>& devices) {
  QStringList notices;
  command_.clear();
  none_->clear();
  for (const DeviceChoice& each : devices) {
    if (each.id.isEmpty() && !each.isMendable) {
      none_->setText(each.name);
      none_->setToolTip(each.note);
    }
    if (!each.isMendable) continue;
    notices << each.name + QStringLiteral(": ") + each.note;
    if (command_.isEmpty()) command_ = each.command;
  }
  text_->setText(notices.join(QChar('\n')));
  none_->setVisible(!none_->text().isEmpty());
  text_->setVisible(!notices.isEmpty());
  copy_->setVisible(!command_.isEmpty());
  setVisible(!none_->isHidden() || !notices.isEmpty());
}

HandChoice::HandChoice(QWidget* parent)
    : QWidget(parent),
      box_(new QComboBox(this)),
      state_(new QLabel(this)),
      arm_(new QPushButton(this)),
      calibrate_(new QPushButton(tr("Calibrate"), this)),
      reset_(new QPushButton(tr("Reset"), this)),
      recording_(new QPushButton(tr("Choose recording…"), this)),
      opening_(new QProgressBar(this)),
      notices_(new DeviceNotices(this)) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  box_->setObjectName(QStringLiteral("hand"));
  box_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  box_->addItem(icon(QStringLiteral("hand")), tr("Scripted hand"), QVariant::fromValue(Hand::Scripted));
  box_->addItem(icon(QStringLiteral("rename")), tr("Manual hand"), QVariant::fromValue(Hand::Manual));
  box_->addItem(icon(QStringLiteral("start")), tr("Recorded hand"), QVariant::fromValue(Hand::Device));
  box_->setItemData(kManual,
                    tr("Shift+left-drag moves, Shift+right-drag rotates, Shift+wheel pushes or pulls. Arrow "
                       "keys step; Shift+arrows rotate."),
                    kNoteRole);
  box_->setItemData(kRecording, tr("No recording is chosen yet."), kNoteRole);
  box_->setToolTip(
      tr("What moves the part while you feel it: a script that presses it against the nearest part, the "
         "manual hand (numbers, keys and mouse), a recording, or a device"));
  recording_->setObjectName(QStringLiteral("chooseRecording"));
  connect(recording_, &QPushButton::clicked, this, &HandChoice::recordingWanted);
  state_->setObjectName(QStringLiteral("deviceState"));
  state_->setWordWrap(true);
  state_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  arm_->setObjectName(QStringLiteral("arm"));
  arm_->setToolTip(tr("Arm or disarm the device. Hold its handle before you arm it."));
  for (QWidget* widget :
       {static_cast<QWidget*>(box_), static_cast<QWidget*>(state_), static_cast<QWidget*>(arm_)})
    layout->addWidget(widget);
  calibrate_->setObjectName(QStringLiteral("calibrate"));
  calibrate_->setToolTip(
      tr("Find the position of the handle: hold it in its rest, or let go of it if the device calibrates "
         "itself"));
  layout->addWidget(calibrate_);
  reset_->setObjectName(QStringLiteral("resetDevice"));
  reset_->setToolTip(tr("Clear the fault. Let go of the handle first, then arm the device again."));
  layout->addWidget(reset_);
  layout->addWidget(recording_);
  opening_->setObjectName(QStringLiteral("opening"));
  opening_->setMaximumHeight(8);
  opening_->setTextVisible(false);
  layout->insertWidget(1, opening_);
  layout->addWidget(notices_);
  connect(reset_, &QPushButton::clicked, this, &HandChoice::resetRequested);
  connect(calibrate_, &QPushButton::clicked, this, &HandChoice::calibrateRequested);
  connect(box_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    isChosen_ = true;
    remember();
    showChosen();
    emit handChanged();
  });
  connect(arm_, &QPushButton::clicked, this, [this] { emit armRequested(!status_.isArmed); });
  box_->setCurrentIndex(rowOfRemembered());
  showChosen();
}

Hand HandChoice::hand() const {
  return box_->currentData().value<Hand>();
}

QString HandChoice::device() const {
  return box_->currentData(kDeviceRole).toString();
}

void HandChoice::choose(const QString& device) {
  if (device.startsWith(kReplay)) {
    box_->setItemData(kRecording, device, kDeviceRole);
    box_->setItemData(kRecording, QFileInfo(device.mid(kReplay.size())).fileName(), kNoteRole);
  }
  if (const int row = rowOf(device); row >= 0) {
    box_->setCurrentIndex(row);
    isChosen_ = true;
  }
  showChosen();
}

void HandChoice::chooseScripted() {
  box_->setCurrentIndex(kScripted);
  isChosen_ = true;
  showChosen();
}

bool HandChoice::isRecorded() const {
  return box_->currentIndex() == kRecording;
}

bool HandChoice::isRecordingMissing() const {
  return isRecorded() && device().isEmpty();
}

int HandChoice::rowOf(const QString& device) const {
  return device.isEmpty() ? -1 : box_->findData(device, kDeviceRole);
}

int HandChoice::rowOfRemembered() const {
  const QString hand = Preferences::hand();
  if (hand == kScriptedHand) return kScripted;
  if (hand == kManualHand) return kManual;
  const auto* model = qobject_cast<const QStandardItemModel*>(box_->model());
  for (int row = kFirstDevice; row < box_->count(); ++row) {
    const bool isWanted = hand.isEmpty() || hand == kDeviceHand + box_->itemText(row);
    if (isWanted && model->item(row)->isEnabled()) return row;
  }
  return kManual;
}

void HandChoice::remember() {
  const int row = box_->currentIndex();
  // The file of a recording belongs to this run.
  if (row == kRecording) return;
  Preferences::setHand(row == kScripted ? kScriptedHand
                       : row == kManual ? kManualHand
                                        : kDeviceHand + box_->currentText());
}

void HandChoice::showDevices(const QVector<DeviceChoice>& devices) {
  notices_->showDevices(devices);
  const QSignalBlocker quiet(box_);
  const int before = box_->currentIndex();
  const QString chosen = device();
  const bool isFixed = before < kFirstDevice;
  listDevices(devices);
  int row = isFixed ? before : rowOf(chosen);
  isChosen_ = isChosen_ && row >= 0;
  // The hand does not change while it holds the part, unless it is gone.
  if (row < 0 || (!isChosen_ && !status_.isTaken())) row = rowOfRemembered();
  box_->setCurrentIndex(row);
  showChosen();
}

void HandChoice::listDevices(const QVector<DeviceChoice>& devices) {
  while (box_->count() > kFirstDevice)
    box_->removeItem(kFirstDevice);
  auto* model = qobject_cast<QStandardItemModel*>(box_->model());
  for (const DeviceChoice& each : devices) {
    if (each.id.isEmpty()) continue;
    const int row = box_->count();
    box_->addItem(icon(QStringLiteral("hand")), each.name, QVariant::fromValue(Hand::Device));
    box_->setItemData(row, each.id, kDeviceRole);
    box_->setItemData(row, each.note, kNoteRole);
    box_->setItemData(row, each.note, Qt::ToolTipRole);
    model->item(row)->setEnabled(each.isUsable);
  }
  // The list is as wide as its longest name, however narrow the panel is.
  int widest = 0;
  for (int row = 0; row < box_->count(); ++row)
    widest = std::max(widest, box_->fontMetrics().horizontalAdvance(box_->itemText(row)));
  box_->view()->setMinimumWidth(widest + box_->iconSize().width() + kRoomOfAnItem);
}

void HandChoice::showStatus(const ServoStatus& status) {
  status_ = status;
  showChosen();
}

void HandChoice::showChosen() {
  const bool isInHand = status_.isRunning && status_.hand == Hand::Device;
  const bool isTaken = isInHand || status_.isOpening;
  const QString text = isTaken ? status_.deviceState : box_->currentData(kNoteRole).toString();
  recording_->setVisible(isRecorded());
  opening_->setVisible(status_.isOpening);
  // Until progress is known, the bar moves to and fro.
  opening_->setRange(0, status_.openingFraction > 0.0 ? kOpeningSteps : 0);
  opening_->setValue(static_cast<int>(status_.openingFraction * kOpeningSteps));
  state_->setText(text);
  state_->setVisible(!text.isEmpty());
  calibrate_->setVisible(isInHand && status_.isUncalibrated);
  reset_->setVisible(isInHand && status_.isFaulted);
  arm_->setVisible(isInHand && status_.isArmable && !status_.isUncalibrated && !status_.isFaulted);
  for (QPushButton* button : {calibrate_, reset_})
    button->setEnabled(!status_.isBusy);
  arm_->setText(status_.isArmed ? tr("Disarm") : tr("Arm: let it push"));
}

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
  recorded_->setText(tr("A recorded hand uses the scale and locks of its recording."));
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
  note_->setText(isUncalibrated ? tr("The part does not move until the device is calibrated (see above).")
                                : tr("Clutch engaged: the part stays while you reposition the device."));
}

void HandWorkspace::refresh() {
  locks_->showSettings(settings());
}

}  // namespace nearfit::ui
