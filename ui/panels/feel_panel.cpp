#include "ui/panels/feel_panel.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include <glm/geometric.hpp>

#include "ui/format.h"
#include "ui/hand_lead.h"
#include "ui/panels/feel_notice.h"
#include "ui/panels/hand_choice.h"
#include "ui/theme.h"

namespace nearfit::ui {
namespace {

const QString kNothing = QStringLiteral("–");

QString muted() {
  return QStringLiteral("color: %1").arg(colours::kMutedText.name());
}

}  // namespace

FeelPanel::FeelPanel(QWidget* settingsButton, QWidget* parent)
    : QWidget(parent),
      hand_(new HandChoice(this)),
      mode_(new QComboBox(this)),
      startStop_(new QPushButton(this)),
      notice_(new FeelNotice(this)) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(12, 10, 12, 12);
  layout->setSpacing(6);
  setUpChoices(*layout, settingsButton);
  setUpReadouts(*layout);
  layout->addStretch(1);

  connect(startStop_, &QPushButton::clicked, this,
          [this] { emit(isTaken_ ? stopRequested() : startRequested()); });
  connect(hand_, &HandChoice::handChanged, this, &FeelPanel::handChanged);
  connect(hand_, &HandChoice::armRequested, this, &FeelPanel::armRequested);
  connect(hand_, &HandChoice::calibrateRequested, this, &FeelPanel::calibrateRequested);
  connect(hand_, &HandChoice::recordingWanted, this, &FeelPanel::recordingWanted);
  connect(hand_, &HandChoice::resetRequested, this, &FeelPanel::resetRequested);
  connect(mode_, QOverload<int>::of(&QComboBox::activated), this,
          [this] { emit modeRequested(mode_->currentData().value<FeelMode>()); });
  connect(notice_, &FeelNotice::restartRequested, this, &FeelPanel::restartRequested);
  showStatus({});
  clearSnapshot();
}

void FeelPanel::setUpChoices(QVBoxLayout& layout, QWidget* settingsButton) {
  mode_->setObjectName(QStringLiteral("panelMode"));
  mode_->setToolTip(tr("How contact feels; the settings explain it"));
  addModes(*mode_);
  mode_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  startStop_->setObjectName(QStringLiteral("startStop"));
  startStop_->setMinimumHeight(34);
  startStop_->setIconSize(QSize(20, 20));
  layout.addWidget(hand_);
  layout.addWidget(mode_);
  layout.addWidget(startStop_);
  layout.addWidget(settingsButton);
  layout.addWidget(notice_);
}

void FeelPanel::setUpReadouts(QVBoxLayout& layout) {
  addHeading(layout, tr("Felt"));
  force_ = addReadout(layout, tr("Force"), QStringLiteral("force"));
  torque_ = addReadout(layout, tr("Torque"), QStringLiteral("torque"));
  distance_ = addReadout(layout, tr("Least distance"), QStringLiteral("distance"));
  minima_ = addReadout(layout, tr("Local minima"), QStringLiteral("minima"));
  contacts_ = addReadout(layout, tr("Contacts"), QStringLiteral("contacts"));
  contacts_->setToolTip(tr("Minima that hold the part"));
  lead_ = addReadout(layout, tr("Hand ahead"), QStringLiteral("lead"));
  lead_->setToolTip(tr("From the part to where the hand wants it"));
  energy_ = addReadout(layout, tr("Energy to hand"), QStringLiteral("energy"));
  energy_->setToolTip(tr("Given to the hand since the start, less what came back"));
  clamped_ = new QLabel(this);
  clamped_->setWordWrap(true);
  clamped_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kForce.name()));
  layout.addWidget(clamped_);
  addHeading(layout, tr("Servo"));
  rate_ = addReadout(layout, tr("Rate"), QStringLiteral("rate"));
  lateness_ = addReadout(layout, tr("Lateness, p99"), QStringLiteral("lateness"));
  tick_ = addReadout(layout, tr("Tick, p99"), QStringLiteral("tick"));
  subSteps_ = addReadout(layout, tr("Sub-steps"), QStringLiteral("subSteps"));
  subSteps_->setToolTip(tr("Steps of the proxy in a tick"));
  overruns_ = addReadout(layout, tr("Overruns"), QStringLiteral("overruns"));
  scheduling_ = new QLabel(this);
  scheduling_->setWordWrap(true);
  scheduling_->setStyleSheet(muted());
  layout.addWidget(scheduling_);
}

void FeelPanel::addHeading(QVBoxLayout& layout, const QString& text) {
  auto* heading = new QLabel(text, this);
  heading->setStyleSheet(QStringLiteral("font-weight: bold; color: #3b4754; padding-top: 10px"));
  layout.addWidget(heading);
}

QLabel* FeelPanel::addReadout(QVBoxLayout& layout, const QString& name, const QString& objectName) {
  auto* row = new QHBoxLayout;
  auto* label = new QLabel(name, this);
  label->setStyleSheet(muted());
  auto* value = new QLabel(kNothing, this);
  value->setObjectName(objectName);
  value->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  row->addWidget(label);
  row->addWidget(value, 1);
  layout.addLayout(row);
  return value;
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
}

void FeelPanel::showDevices(const QVector<DeviceChoice>& devices) {
  hand_->showDevices(devices);
}

void FeelPanel::setStartable(bool isStartable) {
  isStartable_ = isStartable;
  startStop_->setEnabled(isStartable_ || isTaken_);
}

void FeelPanel::showStatus(const ServoStatus& status) {
  isTaken_ = status.isTaken();
  hand_->showStatus(status);
  startStop_->setText(status.isOpening ? tr("Cancel") : isTaken_ ? tr("Stop") : tr("Feel"));
  startStop_->setIcon(icon(isTaken_ ? QStringLiteral("stop") : QStringLiteral("start")));
  setStartable(isStartable_);
  const bool hasTimes = status.isRunning && status.ticks > 0;
  rate_->setText(hasTimes ? QStringLiteral("%1 Hz").arg(status.rate, 0, 'f', 0) : kNothing);
  rate_->setStyleSheet(status.isTooSlow() ? QStringLiteral("color: %1").arg(colours::kWarning.name())
                                          : QString());
  lateness_->setText(hasTimes ? formatDuration(status.latenessP99) : kNothing);
  tick_->setText(hasTimes ? formatDuration(status.tickP99) : kNothing);
  overruns_->setText(hasTimes ? QString::number(status.overruns) : kNothing);
  scheduling_->setText(status.scheduling);
}

void FeelPanel::showMode(FeelMode mode) {
  ui::showMode(*mode_, mode);
}

void FeelPanel::showSnapshot(const ServoSnapshot& snapshot, const Scene& scene) {
  force_->setText(formatForce(glm::length(snapshot.wrench.force)));
  torque_->setText(formatTorque(glm::length(snapshot.wrench.torque)));
  distance_->setText(formatLength(snapshot.distance));
  minima_->setText(QString::number(snapshot.lmdCount) +
                   (snapshot.isTruncated ? QStringLiteral("+") : QString()));
  energy_->setText(formatEnergy(snapshot.energyToHand));
  clamped_->setText(snapshot.isClamped ? tr("Held at the device's limit.") : QString());
  notice_->showSnapshot(snapshot, scene);
  showProxy(snapshot);
}

void FeelPanel::showProxy(const ServoSnapshot& snapshot) {
  const bool isProxy = snapshot.mode == HapticMode::Proxy;
  contacts_->setText(isProxy ? QString::number(snapshot.contactCount) : kNothing);
  lead_->setText(isProxy ? formatLead(handLeadOf(snapshot)) : kNothing);
  subSteps_->setText(isProxy ? QString::number(snapshot.subSteps) : kNothing);
}

void FeelPanel::clearSnapshot() {
  for (QLabel* label : {force_, torque_, distance_, minima_, contacts_, lead_, energy_, subSteps_})
    label->setText(kNothing);
  clamped_->clear();
  notice_->clear();
}

}  // namespace nearfit::ui
