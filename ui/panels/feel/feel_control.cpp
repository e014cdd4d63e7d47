#include "ui/panels/feel/feel_control.h"

#include <QAction>
#include <QFileDialog>
#include <QPushButton>
#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/session/session.h"
#include "ui/model/feel_mode.h"
#include "ui/model/hand_state.h"
#include "ui/model/preset_store.h"
#include "ui/model/scene_work.h"
#include "ui/panels/feel/feel_dialog.h"
#include "ui/panels/feel/feel_panel.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/preferences.h"

namespace nearfit::ui {
namespace {

/// True if there is something to feel what is in hand against.
bool isOtherPartVisible(const Scene& scene) {
  return std::ranges::any_of(scene.parts(), [&scene](const Scene::PartPtr& part) {
    return part->isVisible && !scene.isMoving(part->id);
  });
}

/// Help of the action that starts, while it can be used.
QString startHelp() {
  return FeelControl::tr("Start the servo: feel the moving part against the others");
}

}  // namespace

FeelControl::FeelControl(Session& session, const HandState& hand, SceneWork& work, QWidget* window)
    : QObject(window),
      session_(session),
      hand_(hand),
      work_(work),
      window_(window),
      presets_(new PresetStore(PresetStore::usualFile(), this)),
      dialog_(new FeelDialog(*presets_, window)) {
  makeActions();
  makePanel();
  connectPanel();
  connectSettings();
  connectHand();
  connect(&work_, &SceneWork::busyChanged, this, &FeelControl::updateActions);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] {
    showSettings();
    updateActions();
  });
  showSettings();
  updateActions();
}

void FeelControl::makeActions() {
  start = makeAction(this, "start", tr("&Feel"), QStringLiteral("start"), Qt::Key_F5, startHelp());
  stop = makeAction(this, "stop", tr("S&top"), QStringLiteral("stop"), Qt::Key_F6,
                    tr("Stop the servo and leave the part where it is"));
  clutch = makeAction(this, "clutch", tr("&Clutch"), QStringLiteral("clutch"), Qt::Key_F9,
                      tr("Hold the part still while you reposition the device"));
  clutch->setCheckable(true);
  settings = makeAction(this, "feelSettings", tr("Feel s&ettings…"), QStringLiteral("springs"), {},
                        tr("Mode, cutoff, margin, stiffness, weight and workspace"));
  // They must work from the feel settings too, which stay open beside the window.
  for (QAction* action : {start, stop, clutch})
    action->setShortcutContext(Qt::ApplicationShortcut);
  connect(start, &QAction::triggered, this, &FeelControl::requestStart);
  connect(stop, &QAction::triggered, this, &FeelControl::servoStopRequested);
  connect(clutch, &QAction::triggered, this, &FeelControl::clutchRequested);
  connect(settings, &QAction::triggered, this, [this] {
    dialog_->show();
    dialog_->raise();
  });
}

void FeelControl::makePanel() {
  auto* button = new QPushButton(settings->icon(), tr("Feel settings…"), window_);
  button->setObjectName(QStringLiteral("settingsButton"));
  connect(button, &QPushButton::clicked, settings, &QAction::trigger);
  panel_ = new FeelPanel({button, clutch, *presets_}, window_);
}

void FeelControl::connectPanel() {
  connect(panel_, &FeelPanel::startRequested, start, &QAction::trigger);
  connect(panel_, &FeelPanel::stopRequested, stop, &QAction::trigger);
  connect(panel_, &FeelPanel::restartRequested, this, &FeelControl::restart);
  connect(panel_, &FeelPanel::handChanged, this, &FeelControl::takeChosenHand);
  connect(panel_, &FeelPanel::recordingWanted, this, [this] {
    if (askForRecording() && hand_.status().isTaken()) restart();
  });
  connect(panel_, &FeelPanel::armRequested, this, &FeelControl::armRequested);
  connect(panel_, &FeelPanel::calibrateRequested, this, &FeelControl::calibrateRequested);
  connect(panel_, &FeelPanel::resetRequested, this, &FeelControl::resetRequested);
  connect(panel_, &FeelPanel::settingsEdited, this, [this](const HapticSettings& edited) { change(edited); });
  connect(panel_, &FeelPanel::modeRequested, this,
          [this](FeelMode mode) { change(withMode(session_.scene().haptics(), mode)); });
  connect(panel_, &FeelPanel::presetChosen, this, &FeelControl::usePreset);
}

void FeelControl::connectSettings() {
  connect(dialog_, &FeelDialog::settingsEdited, this,
          [this](const HapticSettings& edited) { change(edited); });
  connect(dialog_, &FeelDialog::presetChosen, this, &FeelControl::usePreset);
  dialog_->showRate(Preferences::rate());
  connect(dialog_, &FeelDialog::rateEdited, this, [this](const RateSettings& rate) {
    Preferences::setRate(rate);
    emit rateChanged(rate);
  });
  connect(presets_, &PresetStore::noted, this, &FeelControl::noted);
  connect(presets_, &PresetStore::failed, this, &FeelControl::failed);
}

void FeelControl::connectHand() {
  connect(&hand_, &HandState::statusChanged, this, [this](const ServoStatus& status) {
    panel_->showStatus(status);
    clutch->setChecked(status.isClutched);
    dialog_->setDevice(status.device);
  });
  connect(&hand_, &HandState::changed, this, &FeelControl::updateActions);
  connect(&hand_, &HandState::snapshotDrawn, this, [this](const ServoSnapshot& snapshot) {
    panel_->showSnapshot(snapshot, session_.scene());
    dialog_->showSnapshot(snapshot);
  });
  connect(&hand_, &HandState::snapshotKept, this, [this](const ServoSnapshot& snapshot) {
    panel_->keepSnapshot(snapshot);
    dialog_->clearSnapshot();
  });
  connect(&hand_, &HandState::snapshotCleared, this, [this] {
    panel_->clearSnapshot();
    dialog_->clearSnapshot();
  });
}

void FeelControl::updateActions() {
  const Scene& scene = session_.scene();
  const bool isTaken = hand_.status().isTaken();
  const QString why = whyNotFelt();
  start->setEnabled(why.isEmpty() && !isTaken);
  setHelp(*start, why.isEmpty() || isTaken ? startHelp() : why);
  start->setStatusTip(isTaken ? QString() : why);
  stop->setEnabled(isTaken);
  clutch->setEnabled(hand_.isHeldBy(Hand::Device));
  panel_->showReadiness(why, scene.parts().size() > 1 && !scene.movingPart());
}

QString FeelControl::whyNotFelt() const {
  const Scene& scene = session_.scene();
  if (scene.parts().size() < 2) return tr("Add at least two parts to feel one against the other.");
  if (!scene.movingPart()) return tr("No part is in hand: select one and take it in hand (Ctrl+H).");
  if (!isOtherPartVisible(scene)) return tr("No other part is visible: nothing can be felt.");
  if (work_.isBusy()) return tr("Wait until the parts are loaded.");
  return {};
}

void FeelControl::showSettings() {
  dialog_->showScene(session_.scene());
  panel_->showSettings(session_.scene().haptics());
}

void FeelControl::loadPresets() {
  presets_->load();
}

void FeelControl::closeSettings() {
  dialog_->hide();
}

void FeelControl::showDevices(const QVector<DeviceChoice>& devices) {
  panel_->showDevices(devices);
}

void FeelControl::chooseScriptedHand() {
  panel_->chooseScriptedHand();
}

void FeelControl::takeChosenHand() {
  const ServoStatus& status = hand_.status();
  const bool isSame = status.hand == panel_->hand() && status.deviceId == panel_->device();
  if (wanted_) wanted_ = {panel_->hand(), panel_->device()};
  // Passing the recorded hand in the list must not ask for a file; the button does that.
  if (status.isTaken() && !isSame && !panel_->isRecordingMissing()) restart();
}

void FeelControl::requestStart() {
  emit sceneNeeded();
  if (panel_->isRecordingMissing() && !askForRecording()) return;
  wanted_ = {panel_->hand(), panel_->device()};
  // Building hierarchies may take seconds; once they are ready the servo starts at once.
  work_.prepareHierarchies([this](bool isReady) {
    const std::optional<WantedHand> wanted = std::exchange(wanted_, std::nullopt);
    if (isReady && wanted) emit servoStartRequested(wanted->hand, wanted->device);
  });
}

void FeelControl::restart() {
  emit servoStopRequested();
  requestStart();
}

void FeelControl::feelWith(const QString& device) {
  panel_->chooseDevice(device);
  requestStart();
}

void FeelControl::prepareHierarchies() {
  work_.prepareHierarchies([this](bool isReady) {
    if (isReady) {
      emit hierarchiesReady();
    } else {
      emit servoStopRequested();
    }
  });
}

bool FeelControl::askForRecording() {
  const QString file =
      QFileDialog::getOpenFileName(window_, tr("Recorded hand"), Preferences::lastFolder(),
                                   tr("Recordings of nearfit and nearfit-cli (*.csv);;All files (*)"));
  if (file.isEmpty()) return false;
  Preferences::rememberFolderOf(file);
  panel_->chooseDevice(QStringLiteral("replay:") + file);
  return true;
}

void FeelControl::change(const HapticSettings& edited, const QString& label) {
  QString refusal;
  try {
    session_.setHaptics(edited, label.toStdString());
  } catch (const UsageError& error) {
    refusal = tr("Not applied: %1. To fix it, %2.")
                  .arg(QString::fromStdString(error.problem()), QString::fromStdString(error.remedy()));
  }
  dialog_->showRefusal(refusal);
  // Back to the settings that apply.
  if (!refusal.isEmpty()) showSettings();
}

void FeelControl::usePreset(const HapticSettings& preset, const QString& name) {
  change(preset, tr("Feel settings: preset %1").arg(name));
}

}  // namespace nearfit::ui
