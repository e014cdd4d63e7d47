#include "ui/shell/main_window.h"

#include <QAction>
#include <QCloseEvent>
#include <QDockWidget>
#include <QFileInfo>
#include <QMenu>
#include <QMimeData>
#include <QPushButton>
#include <QStatusBar>
#include <QTimer>
#include <utility>

#include <glm/geometric.hpp>

#include "ui/files/document.h"
#include "ui/files/recovery/recovery.h"
#include "ui/model/move_guard.h"
#include "ui/model/preset_store.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/feel/feel_dialog.h"
#include "ui/panels/feel/feel_panel.h"
#include "ui/panels/history/history_panel.h"
#include "ui/panels/parts/parts_panel.h"
#include "ui/panels/parts/tree_actions.h"
#include "ui/panels/pose/pose_panel.h"
#include "ui/shell/actions.h"
#include "ui/shell/status_readout.h"
#include "ui/shell/taking_away.h"
#include "ui/shell/welcome_card.h"
#include "ui/shell/window_layout.h"
#include "ui/shell/window_shell.h"
#include "ui/tools/placing/placing_tools.h"
#include "ui/tools/selecting/view_menu.h"
#include "ui/view3d/hand_drag.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/error_box.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kNoteTime = 8000;  ///< [ms]

/// True if the poses differ by more than rounding.
bool isElsewhere(const RigidTransform& a, const RigidTransform& b) {
  constexpr double kSlack = 1e-9;  ///< [m]; for rotations half the angle [rad].
  const glm::dquat turn = glm::conjugate(a.rotation) * b.rotation;
  return glm::distance(a.translation, b.translation) > kSlack ||
         glm::length(glm::dvec3(turn.x, turn.y, turn.z)) > kSlack;
}

}  // namespace

MainWindow::MainWindow(Session& session, QWidget* parent)
    : QMainWindow(parent),
      session_(session),
      selection_(new Selection(session, this)),
      poses_(new ShownPoses(session, this)),
      actions_(new Actions(this)),
      guard_(new MoveGuard(session, this)) {
  const auto shapes = std::make_shared<PartShapeCache>();
  viewport_ = new Viewport(shapes, *selection_, *poses_, this);
  document_ = std::make_unique<Document>(session, shapes, this);
  setCentralWidget(viewport_);
  readout_ = new StatusReadout(statusBar());
  presets_ = new PresetStore(PresetStore::usualFile(), this);
  feelDialog_ = new FeelDialog(*presets_, this);
  setUpPanels();
  actions_->setUpMenus(*this);
  treeActions_->addTo(*actions_->editMenu);
  actions_->setUpToolBar(*this);
  placing_ = new PlacingTools(session_, *selection_, *viewport_, *guard_, this);
  placing_->addTo(*this, *actions_->placeMenu);
  setUpAligning();
  setUpInspecting();
  setUpTakingAway();
  setAcceptDrops(true);
  resize(1360, 860);
  manners_ = new WindowShell(this, actions_->viewMenu, actions_->helpMenu);
  connect(manners_, &WindowShell::tourRequested, this, &MainWindow::beginTour);
  welcome_ =
      new WelcomeCard(actions_->openDemo, manners_->tour(), actions_->addParts, actions_->open, viewport_);

  connectPlacing();
  connectMoveGuard();
  connectFileActions();
  connectEditActions();
  connectViewActions();
  connectPanels();
  viewChanges_ =
      session_.onChange(SceneEvents::Stage::View, [this] { viewport_->setScene(session_.scene()); });
  panelChanges_ = session_.onChange(SceneEvents::Stage::Panels, [this] { showScene(); });
  setDemoScene({});
  viewport_->setScene(session_.scene());
  showScene();
  manners_->settle();
}

MainWindow::~MainWindow() {
  // Hiding the dialog commits a number being typed, so delete it while all receivers still exist.
  delete feelDialog_;
}

void MainWindow::setUpPanels() {
  partsPanel_ = new PartsPanel(*selection_, this);
  treeActions_ = new TreeActions(
      session_, *selection_, [this](const QString& what, const auto& command) { attempt(what, command); },
      this);
  posePanel_ = new PosePanel(this);
  auto* settings = new QPushButton(actions_->feelSettings->icon(), tr("Feel settings…"), this);
  settings->setObjectName(QStringLiteral("settingsButton"));
  connect(settings, &QPushButton::clicked, actions_->feelSettings, &QAction::trigger);
  feelPanel_ = new FeelPanel({settings, actions_->clutch, *presets_}, this);
  QDockWidget* parts = addDock(QStringLiteral("partsDock"), tr("Parts"), partsPanel_, Qt::LeftDockWidgetArea);
  auto* history = new HistoryPanel(session_, this);
  tabifyDockWidget(parts,
                   addDock(QStringLiteral("historyDock"), tr("History"), history, Qt::LeftDockWidgetArea));
  parts->raise();
  connect(document_.get(), &Document::busyChanged, history,
          [this, history] { history->setEnabled(!document_->isBusy()); });
  QDockWidget* pose =
      addDock(QStringLiteral("poseDock"), tr("Pose and mass"), posePanel_, Qt::LeftDockWidgetArea);
  QDockWidget* feel = addDock(QStringLiteral("feelDock"), tr("Feel"), feelPanel_, Qt::RightDockWidgetArea);
  resizeDocks({pose, feel}, {285, 235}, Qt::Horizontal);
  resizeDocks({pose}, {240}, Qt::Vertical);
  auto* separator = new QAction(this);
  separator->setSeparator(true);
  const QList<QAction*> menu =
      QList<QAction*>{actions_->takeInHand, actions_->rename, actions_->recolour, actions_->duplicate} +
      treeActions_->list() + QList<QAction*>{separator, actions_->remove};
  for (QAction* action : menu)
    action->setShortcutVisibleInContextMenu(true);
  partsPanel_->setMenuActions(menu);
  new ViewMenu(*selection_, *viewport_, menu, {actions_->selectAll, actions_->fit}, this);
}

QDockWidget* MainWindow::addDock(const QString& name, const QString& title, QWidget* content,
                                 Qt::DockWidgetArea area) {
  auto* dock = new QDockWidget(title, this);
  dock->setObjectName(name);
  dock->setWidget(content);
  dock->setFeatures(QDockWidget::DockWidgetClosable | QDockWidget::DockWidgetMovable);
  addDockWidget(area, dock);
  actions_->panelsMenu->addAction(dock->toggleViewAction());
  return dock;
}

void MainWindow::setFailureSink(std::function<void(const Failure&)> sink) {
  failureSink_ = std::move(sink);
}

void MainWindow::setDemoScene(const QString& file) {
  demoScene_ = file;
  updateActions();
}

void MainWindow::protectWork(const std::filesystem::path& recoveryFolder) {
  const auto poseInHand = [this]() -> Autosave::PoseInHand {
    const std::optional<PartId> moving = session_.scene().movingPart();
    if (!servo_.isRunning || !moving) return std::nullopt;
    return std::pair(*moving, poseOfMoving());
  };
  recovery_ = new Recovery(recoveryFolder, session_, *document_, poseInHand, this);
  connect(recovery_, &Recovery::noted, this, &MainWindow::showNote);
  connect(recovery_, &Recovery::failed, this, &MainWindow::showFailure);
  recovery_->offer();
}

void MainWindow::showScene() {
  const Scene& scene = session_.scene();
  const QString name = session_.file().empty() ? tr("Untitled") : fromPath(session_.file().filename());
  setWindowTitle(name + QStringLiteral("[*] – Nearfit"));
  showModified();
  partsPanel_->setScene(scene);
  feelDialog_->showScene(scene);
  feelPanel_->showSettings(scene.haptics());
  welcome_->setVisible(scene.parts().empty());
  showSelection();
}

void MainWindow::showModified() {
  const std::optional<PartId> moving = session_.scene().movingPart();
  const Part* held = servo_.isRunning && moving ? session_.scene().find(*moving) : nullptr;
  const bool hasMoved = held != nullptr && isElsewhere(poseOfMoving(), held->worldFromPart);
  const bool isModified = session_.isModified() || hasMoved;
  if (isWindowModified() != isModified) setWindowModified(isModified);
}

void MainWindow::updateActions() {
  const Scene& scene = session_.scene();
  const std::optional<PartId> id = selected();
  const Part* part = id ? scene.find(*id) : nullptr;
  Actions::Availability availability;
  availability.isBusy = document_->isBusy();
  availability.hasSelection = !selection_->isEmpty();
  availability.isSelectionLocked = part != nullptr && scene.isLocked(*part);
  availability.canStart = scene.movingPart().has_value() && scene.parts().size() > 1;
  availability.isServoRunning = servo_.isTaken();
  availability.isHandManual = servo_.isRunning && servo_.hand == Hand::Manual;
  availability.isHandDevice = servo_.isRunning && servo_.hand == Hand::Device;
  actions_->update(session_, availability);
  treeActions_->update(document_->isBusy());
  actions_->openDemo->setEnabled(!document_->isBusy() && !demoScene_.isEmpty());
  feelPanel_->setStartable(actions_->start->isEnabled());
  updateAligning();
}

void MainWindow::showDevices(const QVector<DeviceChoice>& devices) {
  feelPanel_->showDevices(devices);
}

void MainWindow::showServoStatus(const ServoStatus& status) {
  const bool hasChanged = status.isRunning != servo_.isRunning || status.isOpening != servo_.isOpening ||
                          status.hand != servo_.hand;
  servo_ = status;
  feelPanel_->showStatus(status);
  actions_->clutch->setChecked(status.isClutched);
  readout_->showStatus(status);
  feelDialog_->setDevice(status.device);
  takingAway_->showTaken(status.isTaken());
  if (!hasChanged) return;
  if (status.isRunning) {
    const Part* part = session_.scene().find(session_.scene().movingPart().value_or(PartId{}));
    if (part != nullptr) handPose_ = part->worldFromPart;
  } else {
    poses_->show(ShownPoses::Source::Hand, {});
    viewport_->handDrag().setPoint({});
    viewport_->clearSnapshot();
    feelPanel_->clearSnapshot();
    feelDialog_->clearSnapshot();
    readout_->clearSnapshot();
  }
  showHeld();
  showModified();
  showSelection();
}

void MainWindow::showSnapshot(const ServoSnapshot& snapshot) {
  poses_->show(ShownPoses::Source::Hand, {{snapshot.moving, snapshot.proxy}});
  centreInPart_ = snapshot.proxy.inverse().applyToPoint(snapshot.centre);
  viewport_->handDrag().setPoint(isHandManual() ? std::optional(handPose_.applyToPoint(centreInPart_))
                                                : std::nullopt);
  viewport_->showSnapshot(snapshot);
  feelPanel_->showSnapshot(snapshot, session_.scene());
  feelDialog_->showSnapshot(snapshot);
  readout_->showSnapshot(snapshot);
  showHeld();
  showModified();
  if (recovery_ != nullptr) recovery_->autosave().noteMotion();
  takingAway_->showSnapshot(snapshot);
  if (!holds(selected())) return;
  posePanel_->showPose(snapshot.proxy, servo_.hand == Hand::Manual ? handPose_ : snapshot.proxy);
}

void MainWindow::showFailure(const Failure& failure) {
  if (failureSink_) {
    failureSink_(failure);
  } else {
    // The servo must be stoppable whichever window has the focus.
    ui::showFailure(failure, this, {actions_->stop});
  }
}

void MainWindow::showNote(const QString& text) {
  statusBar()->showMessage(text, kNoteTime);
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!document_->mayLeaveScene()) {
    event->ignore();
    return;
  }
  emit servoStopRequested();
  manners_->layout().remember();
  event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  QStringList files;
  for (const QUrl& url : event->mimeData()->urls()) {
    if (url.isLocalFile()) files << url.toLocalFile();
  }
  // Deferred: it asks the user, and the drag source waits until this returns.
  if (!files.isEmpty()) QTimer::singleShot(0, this, [this, files] { document_->dropFiles(files); });
  event->acceptProposedAction();
}

}  // namespace nearfit::ui
