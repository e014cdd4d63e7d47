// What the main window does for the user: the wiring of its actions and panels to the session's commands.
#include <QAction>
#include <QColorDialog>
#include <QMessageBox>

#include "core/error.h"
#include "core/haptics/workspace_mapper.h"
#include "ui/actions.h"
#include "ui/dialogs/error_box.h"
#include "ui/dialogs/feel_dialog.h"
#include "ui/document.h"
#include "ui/main_window.h"
#include "ui/panels/feel_panel.h"
#include "ui/panels/parts_panel.h"
#include "ui/panels/pose_panel.h"
#include "ui/viewport.h"

namespace nearfit::ui {

void MainWindow::connectFileActions() {
  connect(actions_->newScene, &QAction::triggered, this, [this] { document_->newScene(); });
  connect(actions_->open, &QAction::triggered, this, [this] { document_->askAndOpen(); });
  connect(actions_->openDemo, &QAction::triggered, this, [this] { document_->openScene(demoScene_); });
  connect(actions_->addParts, &QAction::triggered, this, [this] { document_->askAndAddParts(); });
  connect(actions_->save, &QAction::triggered, this, [this] { document_->save(); });
  connect(actions_->saveAs, &QAction::triggered, this, [this] { document_->askAndSaveAs(); });
  connect(actions_->exportPlacement, &QAction::triggered, this, &MainWindow::exportPlacement);
  connect(actions_->quit, &QAction::triggered, this, &QWidget::close);
  connect(actions_->about, &QAction::triggered, this, &MainWindow::showAbout);
  connect(document_.get(), &Document::failed, this, &MainWindow::showFailure);
  connect(document_.get(), &Document::noted, this, &MainWindow::showNote);
  connect(document_.get(), &Document::loaded, this, [this] {
    viewport_->fit();
    if (!selected()) partsPanel_->select(session_.scene().movingPart());
  });
  connect(document_.get(), &Document::busyChanged, this, &MainWindow::updateActions);
  connect(document_.get(), &Document::sceneNeeded, posePanel_, &PosePanel::commit);
  connect(document_.get(), &Document::sceneNeeded, this, &MainWindow::poseInHandRequested);
}

void MainWindow::connectEditActions() {
  connect(actions_->undo, &QAction::triggered, this, [this] { session_.undo(); });
  connect(actions_->redo, &QAction::triggered, this, [this] { session_.redo(); });
  connect(actions_->remove, &QAction::triggered, this, &MainWindow::deleteSelected);
  connect(actions_->recolour, &QAction::triggered, this, &MainWindow::recolourSelected);
  connect(actions_->rename, &QAction::triggered, partsPanel_, &PartsPanel::editName);
  connect(actions_->takeInHand, &QAction::triggered, this, [this] { takeInHand(selected()); });
  connect(actions_->duplicate, &QAction::triggered, this, [this] {
    attempt(tr("The part could not be duplicated."),
            [this] { partsPanel_->select(session_.duplicatePart(*selected())); });
  });
}

void MainWindow::connectViewActions() {
  connect(actions_->fit, &QAction::triggered, viewport_, &Viewport::fit);
  connect(actions_->fitSelection, &QAction::triggered, viewport_, [this] {
    if (const std::optional<PartId> part = selected()) viewport_->fitPart(*part);
  });
  const std::pair<QAction*, StandardView> views[] = {{actions_->viewIso, StandardView::Isometric},
                                                     {actions_->viewFront, StandardView::Front},
                                                     {actions_->viewRight, StandardView::Right},
                                                     {actions_->viewTop, StandardView::Top}};
  for (const auto& [action, view] : views) {
    connect(action, &QAction::triggered, viewport_, [this, view = view] { viewport_->setView(view); });
  }
  connect(actions_->seeThrough, &QAction::toggled, viewport_, &Viewport::setSeeThrough);
  connect(actions_->edges, &QAction::toggled, viewport_, &Viewport::setEdgesVisible);
  connect(actions_->minima, &QAction::toggled, viewport_, &Viewport::setMinimaVisible);
  connect(actions_->contacts, &QAction::toggled, viewport_, &Viewport::setContactsVisible);
  connect(actions_->hand, &QAction::toggled, viewport_, &Viewport::setHandVisible);
  connect(actions_->wrench, &QAction::toggled, viewport_, &Viewport::setWrenchVisible);
  viewport_->setSeeThrough(actions_->seeThrough->isChecked());
  connect(viewport_, &Viewport::partPicked, partsPanel_, &PartsPanel::select);
  connect(viewport_, &Viewport::nudged, this, [this](int x, int y, int z) { nudge(glm::dvec3(x, y, z)); });
}

void MainWindow::connectPanels() {
  connect(partsPanel_, &PartsPanel::selectionChanged, this, &MainWindow::showSelection);
  connect(partsPanel_, &PartsPanel::movingPartRequested, this, &MainWindow::takeInHand);
  connect(partsPanel_, &PartsPanel::renameRequested, this, [this](PartId part, const QString& name) {
    attempt(tr("The part could not be renamed."), [&] { session_.renamePart(part, name.toStdString()); });
  });
  connect(partsPanel_, &PartsPanel::visibilityRequested, this, [this](PartId part, bool isVisible) {
    attempt(tr("The part could not be hidden or shown."), [&] { session_.setVisible(part, isVisible); });
  });
  connect(partsPanel_, &PartsPanel::lockRequested, this, [this](PartId part, bool isLocked) {
    attempt(tr("The part could not be locked or unlocked."), [&] { session_.setLocked(part, isLocked); });
  });
  connect(posePanel_, &PosePanel::poseEdited, this, &MainWindow::moveSelected);
  connect(posePanel_, &PosePanel::densityEdited, this, [this](double density) {
    if (const std::optional<PartId> part = selected())
      attempt(tr("The density could not be changed."), [&] { session_.setDensity(*part, density); });
  });
  connectFeel();
}

void MainWindow::connectFeel() {
  connect(feelPanel_, &FeelPanel::startRequested, actions_->start, &QAction::trigger);
  connect(feelPanel_, &FeelPanel::stopRequested, actions_->stop, &QAction::trigger);
  connect(feelPanel_, &FeelPanel::handChanged, this, [this] {
    if (servo_.isRunning && servo_.hand != feelPanel_->hand()) restartServo();
  });
  connect(actions_->start, &QAction::triggered, this, &MainWindow::requestStart);
  connect(actions_->stop, &QAction::triggered, this, &MainWindow::servoStopRequested);
  connect(feelPanel_, &FeelPanel::restartRequested, this, &MainWindow::restartServo);
  connect(feelPanel_, &FeelPanel::modeRequested, this,
          [this](FeelMode mode) { changeHaptics(withMode(session_.scene().haptics(), mode)); });
  connect(actions_->letGo, &QAction::triggered, this, &MainWindow::letGo);
  connect(actions_->feelSettings, &QAction::triggered, this, [this] {
    feelDialog_->show();
    feelDialog_->raise();
  });
  connect(feelDialog_, &FeelDialog::settingsEdited, this, &MainWindow::changeHaptics);
}

void MainWindow::changeHaptics(const HapticSettings& settings) {
  QString refusal;
  try {
    session_.setHaptics(settings);
  } catch (const UsageError& error) {
    refusal = tr("Not taken over: %1. To mend it, %2.")
                  .arg(QString::fromStdString(error.problem()), QString::fromStdString(error.remedy()));
  }
  feelDialog_->showRefusal(refusal);
  // Back to what counts.
  if (!refusal.isEmpty()) showScene();
}

void MainWindow::restartServo() {
  emit servoStopRequested();
  requestStart();
}

void MainWindow::attempt(const QString& what, const std::function<void()>& command) {
  try {
    command();
  } catch (...) {
    showFailure(describe(what, std::current_exception()));
    showScene();
  }
}

void MainWindow::requestStart() {
  posePanel_->commit();
  // In another thread, as it may take seconds: only then can the servo start at once.
  document_->prepareHierarchies([this](bool isReady) {
    if (isReady) emit servoStartRequested(feelPanel_->hand());
  });
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

void MainWindow::takeInHand(std::optional<PartId> part) {
  if (session_.scene().movingPart() == part) return;
  // What was in hand is put down where it is first, so that nothing of what was felt is lost.
  const bool wasRunning = servo_.isRunning;
  emit servoStopRequested();
  attempt(tr("The part could not be taken in hand."), [&] { session_.setMovingPart(part); });
  if (wasRunning && actions_->start->isEnabled()) requestStart();
}

void MainWindow::deleteSelected() {
  const std::optional<PartId> part = selected();
  if (!part) return;
  if (holds(part)) emit servoStopRequested();
  attempt(tr("The part could not be deleted."), [&] { session_.deletePart(*part); });
}

void MainWindow::recolourSelected() {
  const std::optional<PartId> id = selected();
  const Part* part = id ? session_.scene().find(*id) : nullptr;
  if (part == nullptr) return;
  const QColor before =
      QColor::fromRgbF(static_cast<double>(part->colour.r), static_cast<double>(part->colour.g),
                       static_cast<double>(part->colour.b));
  const QColor chosen =
      QColorDialog::getColor(before, this, tr("Colour of %1").arg(QString::fromStdString(part->name)));
  if (!chosen.isValid()) return;
  const Colour colour{static_cast<float>(chosen.redF()), static_cast<float>(chosen.greenF()),
                      static_cast<float>(chosen.blueF())};
  attempt(tr("The part could not be coloured."), [&] { session_.setColour(*id, colour); });
}

void MainWindow::moveSelected(const RigidTransform& worldFromPart) {
  const std::optional<PartId> part = selected();
  if (!part) return;
  if (holds(part)) {
    moveHand(worldFromPart);
  } else {
    attempt(tr("The part could not be moved."), [&] { session_.movePart(*part, worldFromPart); });
  }
}

void MainWindow::nudge(const glm::dvec3& direction) {
  const glm::dvec3 step = direction * posePanel_->step();
  if (servo_.isRunning && servo_.hand == Hand::Manual) {
    moveHand({handPose_.rotation, handPose_.translation + step});
    return;
  }
  const std::optional<PartId> id = selected();
  const Part* part = id ? session_.scene().find(*id) : nullptr;
  if (part == nullptr) return;
  if (holds(id)) {
    showNote(tr("The scripted hand holds this part."));
  } else {
    moveSelected({part->worldFromPart.rotation, part->worldFromPart.translation + step});
  }
}

void MainWindow::moveHand(const RigidTransform& worldFromPart) {
  WorkspaceMapping locks;
  locks.translationLocks = session_.scene().haptics().mapping.translationLocks;
  locks.rotationLocks = session_.scene().haptics().mapping.rotationLocks;
  WorkspaceMapper mapper;
  mapper.engage(handPose_);
  handPose_ = mapper.map(worldFromPart, false, locks);
  emit handMoved(handPose_);
}

void MainWindow::letGo() {
  if (!servo_.isRunning || servo_.hand != Hand::Manual) return;
  handPose_ = poseInHand_;
  emit handMoved(handPose_);
}

void MainWindow::exportPlacement() {
  posePanel_->commit();
  // The report measures, which needs the hierarchies.
  document_->prepareHierarchies([this](bool isReady) {
    if (isReady) exportPreparedPlacement();
  });
}

void MainWindow::exportPreparedPlacement() {
  const std::optional<PartId> moving = session_.scene().movingPart();
  const Part* part = moving ? session_.scene().find(*moving) : nullptr;
  document_->askAndExport(part != nullptr ? poseOf(*part) : RigidTransform{});
}

void MainWindow::showAbout() {
  QMessageBox::about(this, tr("About Nearfit"), aboutText_);
}

}  // namespace nearfit::ui
