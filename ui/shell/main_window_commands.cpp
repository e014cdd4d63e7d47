// MainWindow: connects actions and panels to the session's commands.
#include <QAction>
#include <QColorDialog>
#include <QDockWidget>
#include <QFileDialog>
#include <QMessageBox>
#include <QTimer>
#include <QToolBar>
#include <algorithm>
#include <utility>

#include "ui/files/document.h"
#include "ui/files/part_files.h"
#include "ui/files/recent_files.h"
#include "ui/model/selection.h"
#include "ui/panels/parts/parts_panel.h"
#include "ui/panels/parts/tree_actions.h"
#include "ui/panels/pose/pose_panel.h"
#include "ui/shell/actions.h"
#include "ui/shell/main_window.h"
#include "ui/shell/taking_away.h"
#include "ui/shell/window_shell.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/error_box.h"
#include "ui/widgets/names.h"
#include "ui/widgets/notice_bar.h"
#include "ui/widgets/preferences.h"

namespace nearfit::ui {

void MainWindow::connectFileActions() {
  setUpFiles();
  connect(actions_->newScene, &QAction::triggered, this, [this] { document_->newScene(); });
  connect(actions_->open, &QAction::triggered, this, [this] { document_->askAndOpen(); });
  connect(actions_->openDemo, &QAction::triggered, this, &MainWindow::openDemo);
  connect(actions_->addParts, &QAction::triggered, this, [this] { document_->askAndAddParts(); });
  connect(actions_->save, &QAction::triggered, this, [this] { document_->save(); });
  connect(actions_->saveAs, &QAction::triggered, this, [this] { document_->askAndSaveAs(); });
  connect(actions_->exportPlacement, &QAction::triggered, takingAway_, &TakingAway::exportScene);
  connect(actions_->quit, &QAction::triggered, this, &QWidget::close);
  connect(actions_->about, &QAction::triggered, this, &MainWindow::showAbout);
  connect(document_.get(), &Document::failed, this, &MainWindow::showFailure);
  connect(document_.get(), &Document::noted, this, &MainWindow::showNote);
  const auto showWhole = [this] {
    viewport_->fit();
    if (!selected()) selection_->select(session_.scene().movingPart());
  };
  // A failed load leaves the view alone, but some of several files may have been added.
  connect(document_.get(), &Document::sceneOpened, this, showWhole);
  connect(document_.get(), &Document::partsAdded, this, showWhole);
  connect(document_.get(), &Document::loaded, this, [showWhole](bool isComplete) {
    if (isComplete) showWhole();
  });
  connect(document_.get(), &Document::busyChanged, this, &MainWindow::updateActions);
  connect(document_.get(), &Document::sceneNeeded, posePanel_, &PosePanel::commit);
  connect(document_.get(), &Document::sceneNeeded, this, &MainWindow::poseInHandRequested);
}

void MainWindow::setUpFiles() {
  auto* recent = new RecentFiles(actions_->recentMenu, this);
  connect(recent, &RecentFiles::openRequested, document_.get(), &Document::openScene);
  connect(recent, &RecentFiles::missing, this, [this](const QString& file) {
    showFailure({tr("This scene no longer exists."),
                 tr("Its file was moved or deleted. It was removed from the list.\n\nWhere: %1").arg(file)});
  });
  auto* parts = new PartFiles(session_, *document_, *new NoticeBar(viewport_), actions_->reloadMenu, this);
  connect(parts, &PartFiles::noted, this, &MainWindow::showNote);
  connect(parts, &PartFiles::failed, this, &MainWindow::showFailure);
}

void MainWindow::connectEditActions() {
  connect(actions_->undo, &QAction::triggered, this, [this] { session_.undo(); });
  connect(actions_->redo, &QAction::triggered, this, [this] { session_.redo(); });
  connect(actions_->remove, &QAction::triggered, this, &MainWindow::deleteSelected);
  connect(actions_->recolour, &QAction::triggered, this, &MainWindow::recolourSelected);
  connect(actions_->rename, &QAction::triggered, this, [this] {
    auto* dock = findChild<QDockWidget*>(QStringLiteral("partsDock"));
    dock->show();
    dock->raise();
    partsPanel_->editName();
  });
  connect(actions_->takeInHand, &QAction::triggered, this, [this] {
    if (selected()) takeInHand(selected());
  });
  connect(actions_->selectAll, &QAction::triggered, selection_, &Selection::selectAllVisible);
  connect(actions_->selectNone, &QAction::triggered, selection_, [this] { selection_->select({}); });
  connect(actions_->duplicate, &QAction::triggered, this, [this] {
    attempt(tr("The part could not be duplicated."), [this] {
      const SceneNodes copies = session_.duplicate(selection_->nodes());
      selection_->set(partsOf(session_.scene(), copies), copies.groups);
    });
  });
}

void MainWindow::connectViewActions() {
  connect(actions_->fit, &QAction::triggered, viewport_, &Viewport::fit);
  connect(actions_->fitSelection, &QAction::triggered, viewport_, [this] {
    if (!selection_->parts().empty()) viewport_->fitParts(selection_->parts());
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
}

void MainWindow::connectPanels() {
  connect(selection_, &Selection::changed, this, &MainWindow::showSelection);
  connect(partsPanel_, &PartsPanel::movingPartRequested, this, &MainWindow::takeInHand);
  connect(partsPanel_, &PartsPanel::renameRequested, this, [this](PartId part, const QString& name) {
    attempt(tr("The part could not be renamed."), [&] { session_.renamePart(part, name.toStdString()); });
  });
  connect(partsPanel_, &PartsPanel::groupRenameRequested, this, [this](GroupId group, const QString& name) {
    attempt(tr("The group could not be renamed."), [&] { session_.renameGroup(group, name.toStdString()); });
  });
  connect(partsPanel_, &PartsPanel::visibilityRequested, this,
          [this](const std::vector<PartId>& parts, bool isVisible) {
            attempt(tr("The part could not be hidden or shown."),
                    [&] { session_.setVisible(parts, isVisible); });
          });
  connect(partsPanel_, &PartsPanel::lockRequested, this, &MainWindow::lockNodes);
  connect(treeActions_, &TreeActions::lockRequested, this, &MainWindow::lockNodes);
  connect(partsPanel_, &PartsPanel::renameRefused, this, &MainWindow::showNote);
  // Deferred: the tree view is still handling the drop, which a model change would disturb.
  connect(partsPanel_, &PartsPanel::regroupRequested, this,
          [this](const SceneNodes& nodes, std::optional<GroupId> target) {
            QTimer::singleShot(0, this, [this, nodes, target] {
              attempt(tr("The parts could not be moved there."), [&] { session_.regroup(nodes, target); });
            });
          });
  connect(posePanel_, &PosePanel::poseEdited, this, &MainWindow::moveSelected);
  connect(posePanel_, &PosePanel::densityEdited, this, [this](double density) {
    attempt(tr("The density could not be changed."),
            [&] { session_.setDensity(selection_->parts(), density); });
  });
  connectFeel();
}

void MainWindow::attempt(const QString& what, const std::function<void()>& command) {
  try {
    command();
  } catch (...) {
    showFailure(describe(what, std::current_exception()));
    showScene();
  }
}

void MainWindow::takeInHand(std::optional<PartId> part) {
  if (session_.scene().movingPart() == part) return;
  // Stopping puts the part in hand down where it is; without it the pose felt would be lost.
  const bool wasRunning = servo_.isTaken();
  emit servoStopRequested();
  attempt(tr("The part could not be taken in hand."), [&] { session_.setMovingPart(part); });
  if (wasRunning && actions_->start->isEnabled()) requestStart();
}

void MainWindow::lockNodes(const SceneNodes& nodes, bool isLocked) {
  const std::vector<PartId> parts = partsOf(session_.scene(), nodes);
  const std::optional<PartId> moving = session_.scene().movingPart();
  const bool isMoving = isLocked && moving && std::ranges::count(parts, *moving) > 0;
  const QString name = isMoving ? shortName(session_.scene().find(*moving)->name) : QString();
  if (isMoving && servo_.isTaken())
    return showNote(tr("%1 is being felt: stop (F6) before you lock it").arg(name));
  attempt(tr("The parts could not be locked or unlocked."), [&] {
    session_.setLocked(nodes, isLocked);
    if (isMoving) showNote(tr("%1 is locked and no longer in hand").arg(name));
  });
}

void MainWindow::deleteSelected() {
  const SceneNodes nodes = selection_->nodes();
  if (std::ranges::any_of(nodes.parts, [this](PartId part) { return holds(part); }))
    emit servoStopRequested();
  attempt(tr("The part could not be deleted."), [&] { session_.deleteNodes(nodes); });
}

void MainWindow::recolourSelected() {
  const std::optional<PartId> id = selected();
  const Part* part = id ? session_.scene().find(*id) : nullptr;
  if (part == nullptr) return;
  const QColor before =
      QColor::fromRgbF(static_cast<double>(part->colour.r), static_cast<double>(part->colour.g),
                       static_cast<double>(part->colour.b));
  const QColor chosen = QColorDialog::getColor(before, this, tr("Colour of %1").arg(shortName(part->name)));
  if (!chosen.isValid()) return;
  const Colour colour{static_cast<float>(chosen.redF()), static_cast<float>(chosen.greenF()),
                      static_cast<float>(chosen.blueF())};
  attempt(tr("The part could not be coloured."), [&] { session_.setColour(selection_->parts(), colour); });
}

void MainWindow::setUpTakingAway() {
  takingAway_ = new TakingAway({*this, session_, *selection_, *viewport_, [this] { return poseOfMoving(); }});
  takingAway_->addTo({actions_->fileMenu, actions_->feelMenu, actions_->panelsMenu,
                      findChild<QToolBar*>(QStringLiteral("toolBar")), actions_->exportPlacement});
  connect(takingAway_, &TakingAway::sceneNeeded, posePanel_, &PosePanel::commit);
  connect(takingAway_, &TakingAway::failed, this, &MainWindow::showFailure);
  connect(takingAway_, &TakingAway::noted, this, &MainWindow::showNote);
}

void MainWindow::showAbout() {
  QMessageBox::about(this, tr("About Nearfit"), aboutText_);
}

bool MainWindow::openDemo() {
  return !demoScene_.isEmpty() && document_->openExample(demoScene_);
}

void MainWindow::beginTour() {
  const bool isSomethingThere = !session_.scene().parts().empty() || demoScene_.isEmpty();
  if (isSomethingThere || document_->isBusy()) return manners_->beginTour();
  // An empty window has little to explain, so open the demo first.
  auto* once = new QObject(this);
  connect(document_.get(), &Document::loaded, once, [this, once](bool isComplete) {
    once->deleteLater();
    if (isComplete) manners_->beginTour();
  });
  if (!openDemo()) delete once;
}

}  // namespace nearfit::ui
