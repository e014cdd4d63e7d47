// MainWindow: who holds the part, how contact feels, start and stop.
#include <QAction>
#include <QFileDialog>
#include <utility>

#include "core/base/error.h"
#include "ui/files/document.h"
#include "ui/model/preset_store.h"
#include "ui/panels/feel/feel_dialog.h"
#include "ui/panels/feel/feel_panel.h"
#include "ui/panels/pose/pose_panel.h"
#include "ui/shell/actions.h"
#include "ui/shell/main_window.h"
#include "ui/widgets/error_box.h"
#include "ui/widgets/preferences.h"

namespace nearfit::ui {

void MainWindow::connectFeel() {
  connect(feelPanel_, &FeelPanel::startRequested, actions_->start, &QAction::trigger);
  connect(feelPanel_, &FeelPanel::stopRequested, actions_->stop, &QAction::trigger);
  connect(feelPanel_, &FeelPanel::handChanged, this, [this] {
    const bool isSame = servo_.hand == feelPanel_->hand() && servo_.deviceId == feelPanel_->device();
    if (wanted_) wanted_ = {feelPanel_->hand(), feelPanel_->device()};
    // Passing the recorded hand in the list must not ask for a file; the button does that.
    if (servo_.isTaken() && !isSame && !feelPanel_->isRecordingMissing()) restartServo();
  });
  connect(actions_->start, &QAction::triggered, this, &MainWindow::requestStart);
  connect(actions_->stop, &QAction::triggered, this, &MainWindow::servoStopRequested);
  connect(actions_->clutch, &QAction::triggered, this, &MainWindow::clutchRequested);
  connect(feelPanel_, &FeelPanel::settingsEdited, this,
          [this](const HapticSettings& settings) { changeHaptics(settings); });
  connect(feelPanel_, &FeelPanel::armRequested, this, &MainWindow::armRequested);
  connect(feelPanel_, &FeelPanel::calibrateRequested, this, &MainWindow::calibrateRequested);
  connect(feelPanel_, &FeelPanel::recordingWanted, this, [this] {
    if (askForRecording() && servo_.isTaken()) restartServo();
  });
  connect(feelPanel_, &FeelPanel::resetRequested, this, &MainWindow::resetRequested);
  connect(feelPanel_, &FeelPanel::restartRequested, this, &MainWindow::restartServo);
  connect(feelPanel_, &FeelPanel::modeRequested, this,
          [this](FeelMode mode) { changeHaptics(withMode(session_.scene().haptics(), mode)); });
  connectHand();
  connect(actions_->feelSettings, &QAction::triggered, this, [this] {
    feelDialog_->show();
    feelDialog_->raise();
  });
  connect(feelDialog_, &FeelDialog::settingsEdited, this,
          [this](const HapticSettings& settings) { changeHaptics(settings); });
  connectPresets();
  feelDialog_->showRate(Preferences::rate());
  connect(feelDialog_, &FeelDialog::rateEdited, this, [this](const RateSettings& settings) {
    Preferences::setRate(settings);
    emit rateChanged(settings);
  });
}

void MainWindow::connectPresets() {
  const auto use = [this](const HapticSettings& settings, const QString& name) {
    changeHaptics(settings, tr("Use the feel preset %1").arg(name));
  };
  connect(feelPanel_, &FeelPanel::presetChosen, this, use);
  connect(feelDialog_, &FeelDialog::presetChosen, this, use);
  connect(presets_, &PresetStore::noted, this, &MainWindow::showNote);
  connect(presets_, &PresetStore::failed, this, &MainWindow::showFailure);
  presets_->load();
}

void MainWindow::changeHaptics(const HapticSettings& settings, const QString& label) {
  QString refusal;
  try {
    session_.setHaptics(settings, label.toStdString());
  } catch (const UsageError& error) {
    refusal = tr("Not applied: %1. To fix it, %2.")
                  .arg(QString::fromStdString(error.problem()), QString::fromStdString(error.remedy()));
  }
  feelDialog_->showRefusal(refusal);
  // Back to the settings that apply.
  if (!refusal.isEmpty()) showScene();
}

void MainWindow::restartServo() {
  emit servoStopRequested();
  requestStart();
}

bool MainWindow::askForRecording() {
  const QString file =
      QFileDialog::getOpenFileName(this, tr("Recorded hand"), Preferences::lastFolder(),
                                   tr("Recordings of nearfit and nearfit-cli (*.csv);;All files (*)"));
  if (file.isEmpty()) return false;
  Preferences::rememberFolderOf(file);
  feelPanel_->chooseDevice(QStringLiteral("replay:") + file);
  return true;
}

void MainWindow::requestStart() {
  posePanel_->commit();
  if (feelPanel_->isRecordingMissing() && !askForRecording()) return;
  wanted_ = {feelPanel_->hand(), feelPanel_->device()};
  // Building hierarchies may take seconds; once they are ready the servo starts at once.
  document_->prepareHierarchies([this](bool isReady) {
    const std::optional<WantedHand> wanted = std::exchange(wanted_, std::nullopt);
    if (isReady && wanted) emit servoStartRequested(wanted->hand, wanted->device);
  });
}

void MainWindow::feelWith(const QString& device) {
  feelPanel_->chooseDevice(device);
  requestStart();
}

void MainWindow::prepareHierarchies() {
  document_->prepareHierarchies([this](bool isReady) {
    if (isReady) {
      emit hierarchiesReady();
    } else {
      emit servoStopRequested();
    }
  });
}

}  // namespace nearfit::ui
