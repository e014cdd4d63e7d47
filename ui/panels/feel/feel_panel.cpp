#include "ui/panels/feel/feel_panel.h"

#include <QAction>
#include <QComboBox>
#include <QHBoxLayout>
#include <QHash>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QToolButton>
#include <QVBoxLayout>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "ui/model/hand_lead.h"
#include "ui/model/min_distance.h"
#include "ui/panels/feel/feel_notice.h"
#include "ui/panels/feel/hand_choice.h"
#include "ui/panels/feel/preset_choice.h"
#include "ui/widgets/format.h"
#include "ui/widgets/scroll_column.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

/// A heading with named numbers below it.
class FeelPanel::Readouts : public QWidget {
 public:
  explicit Readouts(const QString& heading, QWidget* parent = nullptr);

  /// Adds a number and returns its label.
  /// @param objectName  Object name of the label.
  QLabel* add(const QString& name, const char* objectName, const QString& toolTip = {});
  /// Adds a text below the numbers, in a colour of the light theme, and returns its label. The text keeps its
  /// line while empty, so that nothing jumps.
  QLabel* addNote(const char* objectName, const QColor& colour);
  /// Shows or hides a number and its name.
  void showNumber(QLabel* number, bool isShown);
  void setHeading(const QString& heading) { heading_->setText(heading); }
  /// Text in place of a missing number.
  static QString nothing() { return QStringLiteral("–"); }

 private:
  QVBoxLayout* layout_;
  QLabel* heading_;
  QHash<QLabel*, QLabel*> names_;  ///< By number.
};

FeelPanel::Readouts::Readouts(const QString& heading, QWidget* parent)
    : QWidget(parent), layout_(new QVBoxLayout(this)), heading_(new QLabel(heading, this)) {
  layout_->setContentsMargins(0, 0, 0, 0);
  layout_->setSpacing(5);
  heading_->setStyleSheet(QStringLiteral("font-weight: bold; color: #3b4754; padding-top: 8px"));
  heading_->setIndent(0);
  layout_->addWidget(heading_);
}

QLabel* FeelPanel::Readouts::add(const QString& name, const char* objectName, const QString& toolTip) {
  auto* row = new QHBoxLayout;
  auto* label = new QLabel(name, this);
  label->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  auto* value = new QLabel(nothing(), this);
  value->setObjectName(QLatin1String(objectName));
  value->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  // Long texts take a second line instead of widening the panel beyond its dock.
  value->setWordWrap(true);
  label->setToolTip(toolTip);
  value->setToolTip(toolTip);
  row->addWidget(label);
  row->addWidget(value, 1);
  layout_->addLayout(row);
  names_.insert(value, label);
  return value;
}

void FeelPanel::Readouts::showNumber(QLabel* number, bool isShown) {
  number->setVisible(isShown);
  names_.value(number)->setVisible(isShown);
}

QLabel* FeelPanel::Readouts::addNote(const char* objectName, const QColor& colour) {
  auto* note = new QLabel(this);
  note->setObjectName(QLatin1String(objectName));
  note->setWordWrap(true);
  note->setStyleSheet(QStringLiteral("color: %1").arg(colour.name()));
  layout_->addWidget(note);
  return note;
}

FeelPanel::FeelPanel(const Parts& parts, QWidget* parent)
    : QWidget(parent),
      hand_(new HandChoice(this)),
      mode_(new QComboBox(this)),
      preset_(new PresetChoice("panelPreset", parts.presets, this)),
      startStop_(new QPushButton(this)),
      whyNot_(new QLabel(this)),
      takeInHand_(new QToolButton(this)),
      notice_(new FeelNotice(this)),
      workspace_(new HandWorkspace(parts.clutch, this)),
      device_(new Readouts(tr("Device"), this)),
      felt_(new Readouts(tr("Felt"), this)),
      servo_(new Readouts(tr("Servo"), this)) {
  setUpReadouts();
  // As wide as its widest content, which may come later.
  QWidget* choices = makeChoices(parts);
  workspace_->showHand(Hand::Device);
  QScrollArea* scroll = makeScrollColumn(choices, "feelScroll");
  showHand();
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(scroll);

  connect(startStop_, &QPushButton::clicked, this,
          [this] { emit(isTaken_ ? stopRequested() : startRequested()); });
  connect(hand_, &HandChoice::handChanged, this, [this] {
    showHand();
    emit handChanged();
  });
  connect(hand_, &HandChoice::armRequested, this, &FeelPanel::armRequested);
  connect(hand_, &HandChoice::calibrateRequested, this, &FeelPanel::calibrateRequested);
  connect(hand_, &HandChoice::recordingWanted, this, &FeelPanel::recordingWanted);
  connect(hand_, &HandChoice::resetRequested, this, &FeelPanel::resetRequested);
  connect(mode_, QOverload<int>::of(&QComboBox::activated), this,
          [this] { emit modeRequested(mode_->currentData().value<FeelMode>()); });
  connect(preset_, &PresetChoice::chosen, this, &FeelPanel::presetChosen);
  connect(workspace_, &FeelPage::edited, this, &FeelPanel::settingsEdited);
  connect(notice_, &FeelNotice::restartRequested, this, &FeelPanel::restartRequested);
  showStatus({});
  clearSnapshot();
}

QWidget* FeelPanel::makeChoices(const Parts& parts) {
  mode_->setObjectName(QStringLiteral("panelMode"));
  mode_->setToolTip(tr("How contact feels; the feel settings explain each mode"));
  addModes(*mode_);
  mode_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  startStop_->setObjectName(QStringLiteral("startStop"));
  startStop_->setMinimumHeight(34);
  startStop_->setIconSize(QSize(20, 20));
  whyNot_->setObjectName(QStringLiteral("whyNotFelt"));
  whyNot_->setWordWrap(true);
  whyNot_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  takeInHand_->setObjectName(QStringLiteral("takeInHandButton"));
  takeInHand_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  takeInHand_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  takeInHand_->setFocusPolicy(Qt::StrongFocus);
  auto* content = new QWidget(this);
  auto* layout = new QVBoxLayout(content);
  layout->setContentsMargins(12, 10, 12, 12);
  layout->setSpacing(6);
  for (QWidget* each :
       {static_cast<QWidget*>(hand_), static_cast<QWidget*>(mode_), static_cast<QWidget*>(preset_),
        static_cast<QWidget*>(startStop_), static_cast<QWidget*>(whyNot_), static_cast<QWidget*>(takeInHand_),
        parts.settingsButton, static_cast<QWidget*>(notice_), static_cast<QWidget*>(felt_),
        static_cast<QWidget*>(device_), static_cast<QWidget*>(workspace_), static_cast<QWidget*>(servo_)})
    layout->addWidget(each);
  layout->addStretch(1);
  // Tab order as on screen; the button was created before the others.
  setTabOrder(startStop_, takeInHand_);
  setTabOrder(takeInHand_, parts.settingsButton);
  return content;
}

void FeelPanel::setUpReadouts() {
  reports_ = device_->add(tr("Reports"), "reportRate", tr("Poses received from the device per second"));
  jitter_ = device_->add(tr("Jitter"), "reportJitter",
                         tr("Mean deviation of the time between two reports from its average"));
  lost_ =
      device_->add(tr("Lost"), "reportsLost", tr("Reports lost or damaged since the part was taken in hand"));
  grip_ = device_->add(tr("Grip"), "grip",
                       tr("Opening angle of the device's gripper; it is recorded, and not felt"));
  device_->showNumber(grip_, false);
  felt_->setObjectName(QStringLiteral("feltNumbers"));
  force_ = felt_->add(tr("Force"), "force");
  torque_ = felt_->add(tr("Torque"), "torque");
  distance_ = felt_->add(tr("Min distance"), "distance",
                         tr("To the nearest part within the cutoff; parts that it overlaps are left out"));
  minima_ = felt_->add(tr("Local minima"), "minima");
  contacts_ = felt_->add(tr("Contacts"), "contacts", tr("Minima that hold the part"));
  lead_ = felt_->add(tr("Hand offset"), "lead", tr("Distance from the part to where the hand wants it"));
  energy_ = felt_->add(tr("Energy to hand"), "energy", tr("Net energy given to the hand since the start"));
  clamped_ = felt_->addNote("clamped", colours::kForce);
  // It comes and goes with each push: without a place of its own it would shift all that is below it.
  clamped_->ensurePolished();
  clamped_->setText(QStringLiteral("1"));
  clamped_->setMinimumHeight(clamped_->sizeHint().height());
  clamped_->clear();
  rate_ = servo_->add(tr("Rate"), "rate");
  lateness_ = servo_->add(tr("Lateness, p99"), "lateness");
  tick_ = servo_->add(tr("Tick, p99"), "tick");
  subSteps_ = servo_->add(tr("Sub-steps"), "subSteps", tr("Steps of the proxy per tick"));
  overruns_ = servo_->add(tr("Overruns"), "overruns");
  scheduling_ = servo_->addNote("scheduling", colours::kMutedText);
}

Hand FeelPanel::hand() const {
  return hand_->hand();
}

QString FeelPanel::device() const {
  return hand_->device();
}

bool FeelPanel::isRecordingMissing() const {
  return hand_->isRecordingMissing();
}

void FeelPanel::chooseDevice(const QString& device) {
  hand_->choose(device);
  showHand();
}

void FeelPanel::chooseScriptedHand() {
  hand_->chooseScripted();
  showHand();
}

void FeelPanel::showDevices(const QVector<DeviceChoice>& devices) {
  hand_->showDevices(devices);
  showHand();
}

void FeelPanel::showHand() {
  workspace_->showHand(hand(), hand_->isRecorded());
}

void FeelPanel::setTakeInHand(QAction& takeInHand) {
  takeInHand_->setDefaultAction(&takeInHand);
}

void FeelPanel::showReadiness(const QString& whyNot, bool isHandEmpty) {
  whyNot_->setText(whyNot);
  isHandEmpty_ = isHandEmpty;
  updateStart();
}

void FeelPanel::updateStart() {
  const QString why = isTaken_ ? QString() : whyNot_->text();
  startStop_->setEnabled(why.isEmpty());
  startStop_->setToolTip(why);
  startStop_->setStatusTip(why);
  whyNot_->setVisible(!why.isEmpty());
  takeInHand_->setVisible(isHandEmpty_ && !isTaken_);
}

void FeelPanel::showStatus(const ServoStatus& status) {
  isTaken_ = status.isTaken();
  hasDevice_ = status.hand == Hand::Device;
  limits_ = status.device;
  hand_->showStatus(status);
  workspace_->showUncalibrated(status.isRunning && status.isUncalibrated);
  startStop_->setText(status.isOpening ? tr("Cancel") : isTaken_ ? tr("Stop") : tr("Feel"));
  startStop_->setIcon(icon(isTaken_ ? QStringLiteral("stop") : QStringLiteral("start")));
  updateStart();
  const bool hasTimes = status.isRunning && status.ticks > 0;
  rate_->setText(hasTimes ? QStringLiteral("%1 Hz").arg(status.rate, 0, 'f', 0) : Readouts::nothing());
  rate_->setStyleSheet(status.isTooSlow() ? QStringLiteral("color: %1").arg(colours::kWarning.name())
                                          : QString());
  lateness_->setText(hasTimes ? formatDuration(status.latenessP99) : Readouts::nothing());
  tick_->setText(hasTimes ? formatDuration(status.tickP99) : Readouts::nothing());
  overruns_->setText(hasTimes ? QString::number(status.overruns) : Readouts::nothing());
  scheduling_->setText(status.scheduling);
  showDevice(status);
}

void FeelPanel::showDevice(const ServoStatus& status) {
  device_->setVisible(status.isRunning && status.hand == Hand::Device);
  const bool hasReports = status.reportRate > 0.0;
  reports_->setText(hasReports ? QStringLiteral("%1 Hz").arg(status.reportRate, 0, 'f', 0)
                               : Readouts::nothing());
  const bool hasJitter = hasReports && status.reportJitter > 0.0;
  jitter_->setText(hasJitter ? QStringLiteral("± ") + formatDuration(status.reportJitter)
                             : Readouts::nothing());
  lost_->setText(hasReports || status.reportsLost > 0 ? QString::number(status.reportsLost)
                                                      : Readouts::nothing());
}

void FeelPanel::showSettings(const HapticSettings& settings) {
  showMode(*mode_, feelModeOf(settings));
  preset_->showSettings(settings);
  workspace_->showSettings(settings);
}

void FeelPanel::showSnapshot(const ServoSnapshot& snapshot, const Scene& scene) {
  felt_->setHeading(tr("Felt"));
  setFelt(true);
  showNumbers(snapshot);
  clamped_->setText(snapshot.isClamped ? limitText(snapshot) : QString());
  notice_->showSnapshot(snapshot, scene);
  workspace_->showClutched(snapshot.isClutched);
  device_->showNumber(grip_, snapshot.grip.has_value());
  if (snapshot.grip) grip_->setText(formatFixed(glm::degrees(*snapshot.grip), 1) + QStringLiteral("°"));
}

QString FeelPanel::limitText(const ServoSnapshot& snapshot) const {
  if (hasDevice_) return tr("Limited to the device's maximum.");
  const bool isForce = glm::length(snapshot.unclampedWrench.force) > limits_.maxForce;
  return isForce ? tr("Limited to %1 N.").arg(formatNumber(limits_.maxForce))
                 : tr("Limited to %1 N·m.").arg(formatNumber(limits_.maxTorque));
}

void FeelPanel::showNumbers(const ServoSnapshot& snapshot) {
  force_->setText(formatForce(glm::length(snapshot.wrench.force)));
  torque_->setText(formatTorque(glm::length(snapshot.wrench.torque)));
  distance_->setText(formatMinDistance(minDistanceOf(snapshot)));
  minima_->setText(formatMinima(snapshot.lmdCount, snapshot.isTruncated));
  minima_->setToolTip(explainMinima(snapshot.isTruncated));
  energy_->setText(formatEnergy(snapshot.energyToHand));
  showProxy(snapshot);
}

void FeelPanel::showProxy(const ServoSnapshot& snapshot) {
  const bool isProxy = snapshot.mode == HapticMode::Proxy;
  contacts_->setText(isProxy ? QString::number(snapshot.contactCount) : Readouts::nothing());
  lead_->setText(isProxy ? formatLead(handLeadOf(snapshot)) : Readouts::nothing());
  subSteps_->setText(isProxy ? QString::number(snapshot.subSteps) : Readouts::nothing());
}

void FeelPanel::showRecorded(const ServoSnapshot& row) {
  showNumbers(row);
  // A recording does not say in which mode it was made.
  contacts_->setText(QString::number(row.contactCount));
  lead_->setText(formatLead(handLeadOf(row)));
  // They stand below the servo, which is at rest.
  subSteps_->setText(Readouts::nothing());
  setFelt(true);
  clearNotices();
  felt_->setHeading(tr("Felt in the recording"));
}

void FeelPanel::clearSnapshot() {
  for (QLabel* label : {force_, torque_, distance_, minima_, contacts_, lead_, energy_, subSteps_})
    label->setText(Readouts::nothing());
  minima_->setToolTip({});
  felt_->setHeading(tr("Felt"));
  setFelt(false);
  clearNotices();
}

void FeelPanel::keepSnapshot(const ServoSnapshot& snapshot) {
  showNumbers(snapshot);
  setFelt(false);
  clearNotices();
}

void FeelPanel::clearNotices() {
  clamped_->clear();
  notice_->clear();
  workspace_->showClutched(false);
}

void FeelPanel::setFelt(bool isFelt) {
  for (QLabel* label : {force_, torque_, distance_, minima_, contacts_, lead_, energy_, subSteps_})
    label->setEnabled(isFelt);
}

}  // namespace nearfit::ui
