#include "ui/shell/status_readout.h"

#include <QLabel>
#include <QStatusBar>

#include "ui/model/hand_state.h"
#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

void setColour(QLabel& label, const QColor& colour) {
  label.setStyleSheet(
      QStringLiteral("border-left: 1px solid #d5dbe1; padding-left: 8px; color: %1").arg(colour.name()));
}

QLabel* addLabel(QStatusBar* bar, const QString& objectName, const QString& widest) {
  auto* label = new QLabel(bar);
  label->setObjectName(objectName);
  label->setMinimumWidth(label->fontMetrics().horizontalAdvance(widest) + 14);
  setColour(*label, colours::kMutedText);
  bar->addPermanentWidget(label);
  return label;
}

}  // namespace

StatusReadout::StatusReadout(const HandState& hand, QStatusBar* bar)
    : QObject(bar),
      rate_(addLabel(bar, QStringLiteral("statusRate"), tr("Servo 1000 Hz"))),
      lateness_(addLabel(bar, QStringLiteral("statusLateness"), tr("Late 0.00 ms (p99)"))),
      minima_(addLabel(bar, QStringLiteral("statusMinima"), tr("LMDs 0000"))),
      distance_(addLabel(bar, QStringLiteral("statusDistance"), tr("Min distance 0000 mm"))) {
  connect(&hand, &HandState::statusChanged, this, &StatusReadout::showStatus);
  connect(&hand, &HandState::snapshotShown, this, &StatusReadout::showSnapshot);
  connect(&hand, &HandState::snapshotCleared, this, &StatusReadout::clearSnapshot);
  showStatus({});
  clearSnapshot();
}

void StatusReadout::showStatus(const ServoStatus& status) {
  rate_->setText(status.isRunning ? tr("Servo %1 Hz").arg(status.rate, 0, 'f', 0) : tr("Servo off"));
  setColour(*rate_, status.isTooSlow() ? colours::kWarning : colours::kMutedText);
  rate_->setToolTip(status.isTooSlow() ? tr("Ticks are lost, so contact feels softer than its settings. Use "
                                            "a smaller cutoff, or hide parts that do not matter.")
                                       : QString());
  lateness_->setText(status.isRunning ? tr("Late %1 (p99)").arg(formatDuration(status.latenessP99))
                                      : tr("Late –"));
}

void StatusReadout::showSnapshot(const ServoSnapshot& snapshot) {
  minima_->setText(tr("LMDs %1").arg(snapshot.lmdCount));
  distance_->setText(tr("Min distance %1").arg(formatLength(snapshot.distance)));
}

void StatusReadout::clearSnapshot() {
  minima_->setText(tr("LMDs –"));
  distance_->setText(tr("Min distance –"));
}

}  // namespace nearfit::ui
