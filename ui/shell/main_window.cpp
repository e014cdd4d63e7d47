#include "ui/shell/main_window.h"

#include <QAction>
#include <QCloseEvent>
#include <QDockWidget>
#include <QMenu>
#include <QMimeData>
#include <QScrollArea>
#include <QStatusBar>
#include <QTimer>
#include <optional>
#include <utility>

#include "ui/files/document.h"
#include "ui/files/export/exporter.h"
#include "ui/files/export/picture_taker.h"
#include "ui/files/file_commands.h"
#include "ui/files/recovery/recovery.h"
#include "ui/model/hand_state.h"
#include "ui/model/move_guard.h"
#include "ui/model/part_checks.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/check/check_panel.h"
#include "ui/panels/clearance/clearance_panel.h"
#include "ui/panels/clearance/map_panel.h"
#include "ui/panels/feel/feel_control.h"
#include "ui/panels/feel/feel_panel.h"
#include "ui/panels/history/command_record_action.h"
#include "ui/panels/history/history_panel.h"
#include "ui/panels/history/undo_actions.h"
#include "ui/panels/parts/part_commands.h"
#include "ui/panels/parts/parts_panel.h"
#include "ui/panels/plots/plot_panel.h"
#include "ui/panels/pose/pose_panel.h"
#include "ui/panels/pose/selected_pose.h"
#include "ui/panels/replay/path_commands.h"
#include "ui/panels/replay/record_action.h"
#include "ui/panels/replay/replay.h"
#include "ui/panels/replay/timeline.h"
#include "ui/panels/suggest/path_suggestion.h"
#include "ui/panels/verdict/scene_check_panel.h"
#include "ui/panels/view/view_actions.h"
#include "ui/shell/dock_place.h"
#include "ui/shell/main_menus.h"
#include "ui/shell/title_and_status.h"
#include "ui/shell/view_focus_frame.h"
#include "ui/shell/welcome_card.h"
#include "ui/shell/window_layout.h"
#include "ui/shell/window_shell.h"
#include "ui/tools/measure/measure_tool.h"
#include "ui/tools/placing/align_tool.h"
#include "ui/tools/placing/drop_tool.h"
#include "ui/tools/placing/hand_control.h"
#include "ui/tools/placing/placing_tools.h"
#include "ui/tools/placing/shown_joints.h"
#include "ui/tools/section/section_tool.h"
#include "ui/tools/selecting/box_select.h"
#include "ui/tools/selecting/view_menu.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/error_box.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/scroll_column.h"
#include "ui/widgets/theme.h"
#include "ui/widgets/view_bar.h"

namespace nearfit::ui {
template <class... Sources>
void MainWindow::listenTo(const Sources&... sources) {
  const auto listen = [this]<class Source>(const Source& source) {
    if constexpr (requires { &Source::failed; })
      connect(&source, &Source::failed, this, &MainWindow::showFailure);
    if constexpr (requires { &Source::noted; }) connect(&source, &Source::noted, this, &MainWindow::showNote);
  };
  (listen(sources), ...);
}

MainWindow::MainWindow(Session& session, QWidget* parent)
    : QMainWindow(parent),
      session_(session),
      selection_(new Selection(session, this)),
      poses_(new ShownPoses(session, this)),
      hand_(new HandState(session, *poses_, this)),
      guard_(new MoveGuard(session, *hand_, this)),
      notes_(new NoteBar(session, this)),
      panelsMenu_(new QMenu(tr("&Panels"), this)),
      units_(new UnitMenu(this)) {
  const auto shapes = std::make_shared<PartShapeCache>();
  viewport_ = new Viewport(shapes, *selection_, *poses_, this);
  setCentralWidget(new ViewArea(viewport_, this));
  connect(hand_, &HandState::snapshotShown, viewport_, &Viewport::showSnapshot);
  connect(viewport_, &Viewport::snapshotDrawn, hand_, &HandState::noteDrawn);
  connect(hand_, &HandState::snapshotKept, viewport_, &Viewport::keepSnapshot);
  connect(hand_, &HandState::snapshotCleared, viewport_, &Viewport::clearSnapshot);
  document_ = std::make_unique<Document>(session, shapes, this);
  connect(document_.get(), &Document::shapesMade, viewport_, &Viewport::takeNewShapes);
  files_ = new FileCommands({session_, *selection_, *hand_, *document_, *viewport_}, this);
  setStatusBar(notes_);
  new StatusReadout(*hand_, notes_);
  new WindowTitle(session_, *hand_, this);
  makePanels();
  makeToolsAndMenus();
  connectCommands();
  setAcceptDrops(true);
  resize(1360, 860);
  new ViewFocusFrame(viewport_);
  const auto* welcome = new WelcomeCard(
      session_, {files_->openDemo, shell_->tour(), files_->addParts, files_->open}, viewport_);
  connect(welcome, &WelcomeCard::recentWanted, files_, &FileCommands::openRecent);
  notes_->endAtCommandsOf(*this);
  changes_ = session_.onChange(SceneEvents::Stage::View, [this, serial = session_.sceneSerial()]() mutable {
    viewport_->setScene(session_.scene());
    if (std::exchange(serial, session_.sceneSerial()) != session_.sceneSerial()) shell_->endTour();
  });
  viewport_->setScene(session_.scene());
  shell_->settle();
}

MainWindow::~MainWindow() {
  // This commits a number being typed, while all listeners of the session still exist.
  feel_->closeSettings();
  // Its dock closes it while it goes, when the model is gone.
  replay_->close();
  suggestion_->close();
}

QDockWidget* MainWindow::addDock(const char* name, const QString& title, QWidget* content,
                                 Qt::DockWidgetArea area) {
  auto* dock = new QDockWidget(title, this);
  dock->setObjectName(QLatin1String(name));
  dock->setWidget(content);
  dock->setFeatures(QDockWidget::DockWidgetClosable | QDockWidget::DockWidgetMovable);
  addDockWidget(area, dock);
  panelsMenu_->addAction(makePanelEntry(*dock));
  return dock;
}

void MainWindow::makePanels() {
  // Panels at the bottom do not take height from those at the sides.
  setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  auto* partsPanel = new PartsPanel(session_, *selection_, this);
  parts_ = new PartCommands({session_, *selection_, *hand_, *document_}, *partsPanel, this);
  checks_ = new PartChecks(session_, *document_, *hand_, this);
  connect(checks_, &PartChecks::changed, partsPanel,
          [this, partsPanel] { partsPanel->showFindings(checks_->badges()); });
  posePanel_ = new PosePanel(this);
  feel_ = new FeelControl(session_, *hand_, *document_, this);
  feel_->panel().setTakeInHand(*parts_->takeInHand);
  history_ = new HistoryPanel(session_, *document_, this);
  undo_ = new UndoActions(session_, *document_, *hand_, this);
  commandRecord_ = new CommandRecordAction(session_, this);
  QDockWidget* parts = addDock("partsDock", tr("Parts"), partsPanel, Qt::LeftDockWidgetArea);
  QDockWidget* history = addDock("historyDock", tr("History"), history_, Qt::LeftDockWidgetArea);
  tabifyDockWidget(parts, history);
  // Behind another tab a list is not hidden, only not seen, and would take the keys.
  connect(history, &QDockWidget::visibilityChanged, history_->list(), [list = history_->list()](bool isSeen) {
    list->setFocusPolicy(isSeen ? Qt::StrongFocus : Qt::NoFocus);
  });
  parts->raise();
  QDockWidget* pose = addDock("poseDock", tr("Pose and mass"), makeScrollColumn(posePanel_, "poseScroll"),
                              Qt::LeftDockWidgetArea);
  QDockWidget* feel = addDock("feelDock", tr("Feel"), &feel_->panel(), Qt::RightDockWidgetArea);
  // Whoever has clicked in a list goes on with keys in the view.
  setTabOrder(partsPanel->list(), history_->list());
  setTabOrder(history_->list(), viewport_);
  resizeDocks({pose, feel}, {285, 235}, Qt::Horizontal);
  resizeDocks({pose}, {264}, Qt::Vertical);
  viewActions_ = new ViewActions(session_, *selection_, *viewport_, this);
  new ViewMenu(*selection_, *viewport_, parts_->menu(), {parts_->selectAll, viewActions_->fit}, this);
}

void MainWindow::makeReviewPanels() {
  auto* clearances = new ClearancePanel(
      {session_, *selection_, *hand_, *viewport_}, [this] { return poses_->poseOfMoving(); }, this);
  connect(units_, &UnitMenu::unitChanged, clearances, &ClearancePanel::refresh);
  clearanceMap_ = new ClearanceMapPanel({session_, *selection_, *hand_, *viewport_}, this);
  connect(units_, &UnitMenu::unitChanged, clearanceMap_, &ClearanceMapPanel::refresh);
  plots_ = new PlotPanel(this);
  auto* timeline = new Timeline(this);
  replay_ = new Replay({session_, *hand_, *guard_, *viewport_}, *timeline, this);
  recording_ = new RecordAction(*hand_, this);
  paths_ = new PathCommands({session_, *replay_, *timeline}, this);
  listenTo(*clearances, *clearanceMap_, *plots_, *replay_, *recording_, *paths_);
  constexpr Qt::DockWidgetArea kBottom = Qt::BottomDockWidgetArea;
  QDockWidget* clearanceDock =
      addDock("clearanceDock", tr("Clearances"), makeScrollPane(clearances, "clearanceScroll"), kBottom);
  QDockWidget* mapDock = addDock("clearanceMapDock", tr("Clearance map"),
                                 makeScrollPane(clearanceMap_, "clearanceMapScroll"), kBottom);
  QDockWidget* plotsDock = addDock("plotsDock", tr("Plots"), makeScrollPane(plots_, "plotsScroll"), kBottom);
  QDockWidget* timelineDock = addDock("timelineDock", tr("Timeline"), timeline, kBottom);
  for (QDockWidget* dock : {clearanceDock, mapDock, plotsDock, timelineDock})
    dock->hide();
  addDockButton(*timelineDock, tr("Show or hide the timeline of a recording"));
  addDockButton(*plotsDock, tr("Show or hide the plots of force, torque, clearance and times"));
  addDockButton(*mapDock, tr("Show or hide how much of a part's surface is how near to others"));
  addDockButton(*clearanceDock, tr("Show or hide the clearances to the other parts"));
  // The timeline is a low strip below the others, which share one place until the user drags them apart.
  splitDockWidget(clearanceDock, timelineDock, Qt::Vertical);
  tabifyDockWidget(clearanceDock, mapDock);
  tabifyDockWidget(mapDock, plotsDock);
  for (QDockWidget* dock : {clearanceDock, mapDock, plotsDock}) {
    connect(dock->toggleViewAction(), &QAction::triggered, dock, [dock](bool isShown) {
      if (isShown) bringToFront(*dock);
    });
  }
  makeCheckPanel(*plotsDock);
  makeSceneCheckPanel(*plotsDock);
  connectReplay(*timelineDock);
  // Whoever turns the colours on wants the numbers too.
  connect(clearanceMap_->colour(), &QAction::triggered, mapDock, [mapDock](bool isOn) {
    if (!isOn) return;
    mapDock->show();
    bringToFront(*mapDock);
  });
}

void MainWindow::makeCheckPanel(QDockWidget& neighbour) {
  auto* panel = new CheckPanel({session_, *selection_, *hand_, *document_, *checks_, *viewport_}, this);
  QDockWidget* dock =
      addDock("checkDock", tr("Check"), makeScrollPane(panel, "checkScroll"), Qt::BottomDockWidgetArea);
  tabifyDockWidget(&neighbour, dock);
  dock->hide();
  connect(dock->toggleViewAction(), &QAction::triggered, dock, [dock](bool isShown) {
    if (isShown) bringToFront(*dock);
  });
  connect(units_, &UnitMenu::unitChanged, panel, &CheckPanel::refresh);
  connect(panel, &CheckPanel::repairRequested, files_, &FileCommands::repair);
  connect(files_, &FileCommands::repaired, panel, &CheckPanel::showRepair);
  connect(parts_, &PartCommands::checkRequested, dock, [dock] {
    dock->show();
    bringToFront(*dock);
  });
}

void MainWindow::makeSceneCheckPanel(QDockWidget& neighbour) {
  sceneCheck_ = new SceneCheckPanel({session_, *selection_, *viewport_}, this);
  listenTo(*sceneCheck_);
  connect(units_, &UnitMenu::unitChanged, sceneCheck_, &SceneCheckPanel::refresh);
  QDockWidget* dock = addDock("sceneCheckDock", tr("Scene check"),
                              makeScrollPane(sceneCheck_, "sceneCheckScroll"), Qt::BottomDockWidgetArea);
  tabifyDockWidget(&neighbour, dock);
  dock->hide();
  addDockButton(*dock, tr("Show or hide which pairs of parts clash, touch or are near"));
  connect(dock->toggleViewAction(), &QAction::triggered, dock, [dock](bool isShown) {
    if (isShown) bringToFront(*dock);
  });
  connect(sceneCheck_->action(), &QAction::triggered, dock, [this, dock] {
    dock->show();
    bringToFront(*dock);
    sceneCheck_->begin();
  });
}

void MainWindow::addDockButton(QDockWidget& dock, const QString& help) {
  setHelp(*dock.toggleViewAction(), help);
  auto* button = new DockButton(dock, statusBar());
  // Before those that were added earlier, and after the numbers, whose widths change.
  constexpr int kAfterNumbers = 1;
  statusBar()->insertPermanentWidget(kAfterNumbers, button);
}

void MainWindow::connectReplay(QDockWidget& timelineDock) {
  // Glyphs and numbers beside them are of one motion: felt, or played.
  connect(replay_, &Replay::opened, hand_, &HandState::clearKept);
  connect(replay_, &Replay::opened, &timelineDock, [&timelineDock] {
    timelineDock.show();
    timelineDock.raise();
  });
  connect(replay_, &Replay::opened, plots_, &PlotPanel::showRecording);
  connect(replay_, &Replay::rowsChanged, plots_, &PlotPanel::showRecording);
  connect(replay_, &Replay::timeShown, plots_, &PlotPanel::setRecordingTime);
  connect(replay_, &Replay::closed, plots_, &PlotPanel::showLive);
  connect(replay_, &Replay::rowShown, &feel_->panel(), &FeelPanel::showRecorded);
  connect(replay_, &Replay::closed, &feel_->panel(), &FeelPanel::clearSnapshot);
  // Whoever closes the timeline wants the scene back.
  connect(timelineDock.toggleViewAction(), &QAction::toggled, this, [this](bool isShown) {
    if (!isShown && !isMinimized()) replay_->close();
  });
}

void MainWindow::makeToolsAndMenus() {
  placing_ = new PlacingTools(session_, *selection_, *viewport_, *guard_, *document_, this);
  handControl_ = new HandControl({session_, *selection_, *guard_, *hand_, *placing_, *viewport_}, this);
  selectedPose_ = new SelectedPose({session_, *selection_, *poses_, *hand_, *guard_, *document_, *viewport_},
                                   *posePanel_);
  auto* align =
      new AlignTool({session_, *selection_, *viewport_, *guard_, *hand_, *document_, *placing_}, this);
  new ShownJoints(session_, *selection_, *viewport_, this);
  auto* drop = new DropTool({session_, *selection_, *viewport_, *guard_, *hand_, *document_}, this);
  auto* measure = new MeasureTool(session_, *viewport_, this);
  auto* section = new SectionTool(session_, *viewport_, this);
  auto* box = new BoxSelect(*selection_, *viewport_, this);
  auto* exporter =
      new Exporter(session_, *selection_, *document_, [this] { return poses_->poseOfMoving(); }, this);
  auto* pictures = new PictureTaker(session_, viewport_->pictures(), this);
  makeReviewPanels();
  suggestion_ = new PathSuggestion({session_, *hand_, *viewport_}, this);
  const auto* menus = new MainMenus(
      this, {*files_,       *exporter,   *pictures, *undo_,         *commandRecord_, *parts_, *box,
             *viewActions_, *measure,    *section,  *placing_,      *align,          *drop,   *feel_,
             *handControl_, *recording_, *replay_,  *clearanceMap_, *sceneCheck_,    *paths_, *suggestion_},
      panelsMenu_, units_);
  shell_ = new WindowShell(this, *files_, menus->viewMenu(), menus->helpMenu());
  listenTo(*placing_, *handControl_, *selectedPose_, *align, *drop, *box, *exporter, *pictures);
  connect(units_, &UnitMenu::unitChanged, measure, &MeasureTool::refresh);
  connect(units_, &UnitMenu::unitChanged, history_, &HistoryPanel::refresh);
  connect(units_, &UnitMenu::unitChanged, selectedPose_, &SelectedPose::refresh);
  connect(exporter, &Exporter::sceneNeeded, posePanel_, &PosePanel::commit);
  connect(clearanceMap_, &ClearanceMapPanel::exportWanted, exporter, &Exporter::exportMap);
}

void MainWindow::connectCommands() {
  listenTo(*files_, *parts_, *feel_, *undo_, *commandRecord_, *suggestion_);
  for (const NumberField* field : findChildren<NumberField*>())
    connect(field, &NumberField::noted, this, &MainWindow::showNote);
  feel_->loadPresets();
  connect(feel_, &FeelControl::sceneNeeded, posePanel_, &PosePanel::commit);
  // Keys that move the hand go to whatever has the focus.
  connect(feel_->start, &QAction::triggered, viewport_, [this] { viewport_->setFocus(); });
  connect(suggestion_, &PathSuggestion::sceneNeeded, posePanel_, &PosePanel::commit);
  connect(suggestion_, &PathSuggestion::sceneNeeded, placing_, &PlacingTools::commit);
  // A recording and a suggested path would both draw what is in hand.
  connect(suggestion_, &PathSuggestion::sceneNeeded, replay_, &Replay::close);
  connect(replay_, &Replay::opened, suggestion_, &PathSuggestion::close);
  connect(suggestion_, &PathSuggestion::feelRequested, feel_->start, &QAction::trigger);
  connect(undo_, &UndoActions::sceneNeeded, placing_, &PlacingTools::commit);
  connect(commandRecord_, &CommandRecordAction::sceneNeeded, posePanel_, &PosePanel::commit);
  connect(commandRecord_, &CommandRecordAction::sceneNeeded, placing_, &PlacingTools::commit);
  connect(parts_, &PartCommands::servoStopRequested, feel_, &FeelControl::servoStopRequested);
  connect(parts_, &PartCommands::servoStartRequested, feel_->start, &QAction::trigger);
  connect(parts_, &PartCommands::unitChangeRequested, files_, &FileCommands::changeUnit);
  connect(parts_, &PartCommands::refineRequested, files_, &FileCommands::refine);
  connect(selectedPose_, &SelectedPose::moveRequested, handControl_, &HandControl::place);
  connect(selectedPose_, &SelectedPose::stepRequested, handControl_, &HandControl::step);
  // A number that was refused, or that joints did not allow, must not stay.
  connect(placing_, &PlacingTools::failed, selectedPose_, &SelectedPose::refresh);
  connect(placing_, &PlacingTools::noted, selectedPose_, &SelectedPose::refresh);
}

void MainWindow::setFailureSink(std::function<void(const Failure&)> sink) {
  failureSink_ = std::move(sink);
}

void MainWindow::setDemoScene(const QString& file) {
  files_->setDemoScene(file);
}

void MainWindow::setGuide(const QString& file) {
  shell_->setGuide(file);
}

bool MainWindow::openDemo() {
  return files_->showDemo();
}

void MainWindow::beginTour() {
  shell_->beginTour();
}

void MainWindow::setAboutText(const QString& text) {
  shell_->setAboutText(text);
}

void MainWindow::protectWork(const std::filesystem::path& recoveryFolder) {
  auto* recovery = new Recovery(recoveryFolder, session_, *document_, *hand_, this);
  listenTo(*recovery);
  recovery->offer();
}

void MainWindow::showFailure(const Failure& failure) {
  if (failureSink_) {
    failureSink_(failure);
  } else {
    // The servo must be stoppable whichever window has the focus.
    ui::showFailure(failure, this, {feel_->stop});
  }
}

void MainWindow::showNote(const QString& text) {
  notes_->note(text);
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!document_->mayLeaveScene()) {
    event->ignore();
    return;
  }
  emit feel_->servoStopRequested();
  shell_->layout().remember();
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
