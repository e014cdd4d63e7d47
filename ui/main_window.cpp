#include "ui/main_window.h"

#include <QAction>
#include <QCloseEvent>
#include <QDockWidget>
#include <QFileInfo>
#include <QMenu>
#include <QMimeData>
#include <QPushButton>
#include <QStatusBar>
#include <utility>

#include "ui/actions.h"
#include "ui/dialogs/error_box.h"
#include "ui/dialogs/feel_dialog.h"
#include "ui/document.h"
#include "ui/feel_mode.h"
#include "ui/panels/feel_panel.h"
#include "ui/panels/parts_panel.h"
#include "ui/panels/pose_panel.h"
#include "ui/paths.h"
#include "ui/preferences.h"
#include "ui/status_readout.h"
#include "ui/theme.h"
#include "ui/viewport.h"
#include "ui/welcome_card.h"

namespace nearfit::ui {
namespace {

constexpr int kNoteTime = 8000;  ///< [ms]

}  // namespace

MainWindow::MainWindow(Session& session, QWidget* parent)
    : QMainWindow(parent), session_(session), actions_(new Actions(this)) {
  const auto shapes = std::make_shared<PartShapeCache>();
  viewport_ = new Viewport(shapes, this);
  document_ = std::make_unique<Document>(session, shapes, this);
  setCentralWidget(viewport_);
  readout_ = new StatusReadout(statusBar());
  feelDialog_ = new FeelDialog(this);
  setUpPanels();
  actions_->setUpMenus(*this);
  actions_->setUpToolBar(*this);
  welcome_ = new WelcomeCard(actions_->openDemo, actions_->addParts, actions_->open, viewport_);
  setAcceptDrops(true);
  resize(1360, 860);
  restoreGeometry(Preferences::windowGeometry());

  connectFileActions();
  connectEditActions();
  connectViewActions();
  connectPanels();
  session_.onChange([this] { showScene(); });
  setDemoScene({});
  showScene();
}

MainWindow::~MainWindow() = default;

void MainWindow::setUpPanels() {
  partsPanel_ = new PartsPanel(this);
  posePanel_ = new PosePanel(this);
  auto* settings = new QPushButton(actions_->feelSettings->icon(), tr("Feel settings…"), this);
  settings->setObjectName(QStringLiteral("settingsButton"));
  connect(settings, &QPushButton::clicked, actions_->feelSettings, &QAction::trigger);
  feelPanel_ = new FeelPanel(settings, this);
  addDock(QStringLiteral("partsDock"), tr("Parts"), partsPanel_, Qt::LeftDockWidgetArea);
  QDockWidget* pose =
      addDock(QStringLiteral("poseDock"), tr("Pose and mass"), posePanel_, Qt::LeftDockWidgetArea);
  QDockWidget* feel = addDock(QStringLiteral("feelDock"), tr("Feel"), feelPanel_, Qt::RightDockWidgetArea);
  resizeDocks({pose, feel}, {285, 235}, Qt::Horizontal);
  resizeDocks({pose}, {240}, Qt::Vertical);
  auto* separator = new QAction(this);
  separator->setSeparator(true);
  partsPanel_->setMenuActions({actions_->takeInHand, actions_->rename, actions_->recolour,
                               actions_->duplicate, separator, actions_->remove});
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

void MainWindow::showScene() {
  const Scene& scene = session_.scene();
  const QString name = session_.file().empty() ? tr("Untitled") : fromPath(session_.file().filename());
  setWindowTitle(name + QStringLiteral("[*] – Nearfit"));
  setWindowModified(session_.isModified());
  viewport_->setScene(scene);
  partsPanel_->setScene(scene);
  feelDialog_->showScene(scene);
  feelPanel_->showMode(feelModeOf(scene.haptics()));
  welcome_->setVisible(scene.parts().empty());
  showSelection();
}

void MainWindow::showSelection() {
  const std::optional<PartId> id = selected();
  const Part* part = id ? session_.scene().find(*id) : nullptr;
  viewport_->setSelected(id);
  const bool isInHand = holds(id);
  const bool isEditable = part != nullptr && !part->isLocked && (!isInHand || servo_.hand == Hand::Manual);
  posePanel_->showPart(part != nullptr ? QString::fromStdString(part->name) : QString(), isEditable);
  posePanel_->showMass(part);
  if (isInHand && servo_.hand == Hand::Manual) {
    posePanel_->showPose(poseInHand_, handPose_);
  } else if (part != nullptr) {
    posePanel_->showPose(poseOf(*part));
  }
  updateActions();
}

void MainWindow::updateActions() {
  const Scene& scene = session_.scene();
  const std::optional<PartId> id = selected();
  const Part* part = id ? scene.find(*id) : nullptr;
  Actions::Availability availability;
  availability.isBusy = document_->isBusy();
  availability.hasSelection = part != nullptr;
  availability.isSelectionLocked = part != nullptr && part->isLocked;
  availability.canStart = scene.movingPart().has_value() && scene.parts().size() > 1;
  availability.isServoRunning = servo_.isRunning;
  availability.isHandManual = servo_.isRunning && servo_.hand == Hand::Manual;
  actions_->update(session_, availability);
  actions_->openDemo->setEnabled(!document_->isBusy() && !demoScene_.isEmpty());
  feelPanel_->setStartable(actions_->start->isEnabled());
}

void MainWindow::showServoStatus(const ServoStatus& status) {
  const bool hasChanged = status.isRunning != servo_.isRunning || status.hand != servo_.hand;
  servo_ = status;
  feelPanel_->showStatus(status);
  readout_->showStatus(status);
  feelDialog_->setDevice(status.device);
  if (!hasChanged) return;
  if (status.isRunning) {
    const Part* part = session_.scene().find(session_.scene().movingPart().value_or(PartId{}));
    if (part != nullptr) handPose_ = poseInHand_ = part->worldFromPart;
  } else {
    viewport_->clearSnapshot();
    feelPanel_->clearSnapshot();
    feelDialog_->clearSnapshot();
    readout_->clearSnapshot();
  }
  showSelection();
}

void MainWindow::showSnapshot(const ServoSnapshot& snapshot) {
  poseInHand_ = snapshot.proxy;
  viewport_->showSnapshot(snapshot);
  feelPanel_->showSnapshot(snapshot, session_.scene());
  feelDialog_->showSnapshot(snapshot);
  readout_->showSnapshot(snapshot);
  if (!holds(selected())) return;
  posePanel_->showPose(poseInHand_, servo_.hand == Hand::Manual ? handPose_ : poseInHand_);
}

void MainWindow::showFailure(const Failure& failure) {
  if (failureSink_) {
    failureSink_(failure);
  } else {
    ui::showFailure(failure, this);
  }
}

void MainWindow::showNote(const QString& text) {
  statusBar()->showMessage(text, kNoteTime);
}

std::optional<PartId> MainWindow::selected() const {
  return partsPanel_->selected();
}

bool MainWindow::holds(std::optional<PartId> part) const {
  return servo_.isRunning && part && session_.scene().movingPart() == part;
}

RigidTransform MainWindow::poseOf(const Part& part) const {
  return holds(part.id) ? poseInHand_ : part.worldFromPart;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!document_->mayLeaveScene()) {
    event->ignore();
    return;
  }
  emit servoStopRequested();
  Preferences::setWindowGeometry(saveGeometry());
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
  document_->openFiles(files);
}

}  // namespace nearfit::ui
