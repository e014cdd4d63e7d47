#include "ui/shell/taking_away.h"

#include <QAction>
#include <QDockWidget>
#include <QFileInfo>
#include <QMainWindow>
#include <QMenu>
#include <QToolBar>
#include <optional>

#include "ui/files/export/exporter.h"
#include "ui/files/export/picture_taker.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/clearance/clearance_panel.h"
#include "ui/panels/clearance/clearance_search.h"
#include "ui/panels/plots/plot_panel.h"
#include "ui/panels/replay/replay.h"
#include "ui/panels/replay/timeline.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/format.h"
#include "ui/widgets/names.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/save_file.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

TakingAway::TakingAway(const Window& window)
    : QObject(&window.window),
      window_(window),
      segment_(window.viewport.overlay(), colours::kAccent),
      exporter_(new Exporter(window.session, window.selection, window.poseOfMoving, &window.window)),
      pictures_(new PictureTaker(window.session, window.viewport.pictures(), &window.window)),
      search_(new ClearanceSearch(window.session, window.poseOfMoving, this)) {
  setUpDocks();
  setUpActions();
  connectClearance();
  connectReplay();
  connect(exporter_, &Exporter::failed, this, &TakingAway::failed);
  connect(exporter_, &Exporter::noted, this, &TakingAway::noted);
  connect(pictures_, &PictureTaker::failed, this, &TakingAway::failed);
  connect(pictures_, &PictureTaker::noted, this, &TakingAway::noted);
  connect(plots_, &PlotPanel::failed, this, &TakingAway::failed);
  connect(plots_, &PlotPanel::noted, this, &TakingAway::noted);
}

TakingAway::~TakingAway() = default;

QDockWidget* TakingAway::addDock(const char* name, const QString& title, QWidget* content,
                                 Qt::DockWidgetArea area) {
  auto* dock = new QDockWidget(title, &window_.window);
  dock->setObjectName(QLatin1String(name));
  dock->setWidget(content);
  dock->setFeatures(QDockWidget::DockWidgetClosable | QDockWidget::DockWidgetMovable);
  window_.window.addDockWidget(area, dock);
  dock->hide();
  return dock;
}

void TakingAway::setUpDocks() {
  clearances_ = new ClearancePanel(window_.session, *search_, &window_.window);
  plots_ = new PlotPanel(&window_.window);
  timeline_ = new Timeline(&window_.window);
  replay_ = new Replay(window_.session, *timeline_, &window_.window);
  clearanceDock_ = addDock("clearanceDock", tr("Clearances"), clearances_, Qt::BottomDockWidgetArea);
  plotsDock_ = addDock("plotsDock", tr("Plots"), plots_, Qt::BottomDockWidgetArea);
  timelineDock_ = addDock("timelineDock", tr("Timeline"), timeline_, Qt::BottomDockWidgetArea);
  // The timeline is as wide as the window, below the two others side by side.
  window_.window.splitDockWidget(clearanceDock_, timelineDock_, Qt::Vertical);
  window_.window.splitDockWidget(clearanceDock_, plotsDock_, Qt::Horizontal);
  // By their size hints, curves would get a strip beside the table.
  const auto share = [this](bool isShown) {
    if (!isShown || !clearanceDock_->isVisible() || !plotsDock_->isVisible()) return;
    const int both = clearanceDock_->width() + plotsDock_->width();
    const bool areBeside = clearanceDock_->y() == plotsDock_->y();
    if (areBeside && 5 * plotsDock_->width() < 2 * both)
      window_.window.resizeDocks({clearanceDock_, plotsDock_}, {both / 2, both / 2}, Qt::Horizontal);
  };
  for (const QDockWidget* dock : {clearanceDock_, plotsDock_})
    connect(dock->toggleViewAction(), &QAction::triggered, this, share, Qt::QueuedConnection);
}

void TakingAway::setUpActions() {
  const auto make = [this](const char* name, const QString& text, const char* iconName, const char* keys) {
    auto* action = new QAction(icon(QLatin1String(iconName)), text, this);
    action->setObjectName(QLatin1String(name));
    action->setShortcut(QKeySequence(QLatin1String(keys)));
    return action;
  };
  copy_ = make("copyPlacement", tr("&Copy placement"), "copy", "Ctrl+Shift+C");
  copy_->setToolTip(tr("Copy the selected part's placement as a 4x4 matrix by rows, in metres"));
  connect(copy_, &QAction::triggered, exporter_, &Exporter::copyPlacement);
  record_ = make("record", tr("&Record…"), "record", "F8");
  record_->setCheckable(true);
  record_->setToolTip(tr("Record what is felt to a file, until you stop feeling the part"));
  connect(record_, &QAction::triggered, this, &TakingAway::toggleRecord);
  openRecording_ = make("openRecording", tr("&Play a recording…"), "start", "Shift+F8");
  openRecording_->setToolTip(tr("Show a recorded motion on a timeline"));
  connect(openRecording_, &QAction::triggered, replay_, &Replay::askAndOpen);
}

void TakingAway::addTo(const Menus& menus) {
  const QList<QAction*> file = menus.file->actions();
  const int place = file.indexOf(menus.exportAction) + 1;
  menus.file->insertActions(place < file.size() ? file.at(place) : nullptr,
                            {copy_, pictures_->save(), pictures_->copy()});
  menus.toolBar->insertAction(menus.exportAction, record_);
  menus.feel->addSeparator();
  menus.feel->addActions({record_, openRecording_});
  for (QDockWidget* dock : {clearanceDock_, plotsDock_, timelineDock_})
    menus.panels->addAction(dock->toggleViewAction());
}

void TakingAway::connectClearance() {
  connect(clearances_, &ClearancePanel::failed, this, &TakingAway::failed);
  connect(clearances_, &ClearancePanel::noted, this, &TakingAway::noted);
  connect(clearances_, &ClearancePanel::chosenChanged, this, &TakingAway::showPair);
  connect(clearances_, &ClearancePanel::pairChosen, this, [this](PartId part, PartId other) {
    window_.selection.set({other, part});
    window_.viewport.fitParts({part, other});
  });
}

void TakingAway::showPair() {
  const std::optional<PartClearance> pair = clearances_->chosen();
  if (!pair && !segment_.isShown()) return;
  if (pair) {
    segment_.show(pair->partPoint, pair->otherPoint);
  } else {
    segment_.clear();
  }
  window_.viewport.requestRender();
}

void TakingAway::connectReplay() {
  connect(replay_, &Replay::failed, this, &TakingAway::failed);
  connect(replay_, &Replay::noted, this, &TakingAway::noted);
  connect(replay_, &Replay::opened, this, [this] {
    timelineDock_->show();
    timelineDock_->raise();
    plots_->showRecording(replay_->rows());
    timeline_->setFocus();
    emit replayingChanged(true);
  });
  connect(replay_, &Replay::rowShown, this, [this](const ServoSnapshot& snapshot) {
    window_.viewport.poses().show(ShownPoses::Source::Replay, {{snapshot.moving, snapshot.proxy}});
    window_.viewport.showSnapshot(snapshot);
    plots_->setRecordingTime(snapshot.time);
  });
  connect(replay_, &Replay::closed, this, [this] {
    window_.viewport.poses().show(ShownPoses::Source::Replay, {});
    window_.viewport.clearSnapshot();
    plots_->showLive();
    emit replayingChanged(false);
  });
  // Whoever closes the timeline wants the scene back.
  connect(timelineDock_->toggleViewAction(), &QAction::toggled, this, [this](bool isShown) {
    if (!isShown && !window_.window.isMinimized()) replay_->close();
  });
}

void TakingAway::exportScene() {
  emit sceneNeeded();
  exporter_->askAndExport();
}

void TakingAway::openRecording(const QString& file) {
  replay_->open(file);
}

void TakingAway::showTaken(bool isTaken) {
  if (isTaken_ == isTaken) return;
  isTaken_ = isTaken;
  replay_->setAllowed(!isTaken);
  openRecording_->setEnabled(!isTaken);
  timeline_->setEnabled(!isTaken);
}

void TakingAway::showSnapshot(const ServoSnapshot& snapshot) {
  search_->showSnapshot(snapshot);
}

void TakingAway::showTicks(const std::vector<MotionRow>& rows, quint64 lost) {
  plots_->add(rows, lost);
}

void TakingAway::toggleRecord(bool isOn) {
  if (!isOn) {
    emit recordRequested({});
    return;
  }
  const std::optional<QString> file = askForSave({tr("Record to"),
                                                  Preferences::lastFolder() + QStringLiteral("/felt.csv"),
                                                  {tr("Recordings (*.csv)")},
                                                  {QStringLiteral("csv")}},
                                                 &window_.window);
  if (!file) {
    record_->setChecked(false);
    return;
  }
  Preferences::rememberFolderOf(*file);
  emit recordRequested(*file);
  if (!isTaken_)
    emit noted(tr("The next feel will be recorded to %1").arg(shortName(QFileInfo(*file).fileName())));
}

void TakingAway::showRecording(const QString& file, double seconds) {
  const bool isOn = !file.isEmpty();
  record_->setChecked(isOn);
  QString text = tr("&Record…");
  if (isOn && seconds > 0.0) text = tr("Stop &recording (%1 s)").arg(seconds, 0, 'f', 0);
  if (isOn && !(seconds > 0.0))
    text = tr("Cancel &recording to %1").arg(shortName(QFileInfo(file).fileName()));
  if (record_->text() != text) record_->setText(text);
}

void TakingAway::showRecordingFailed() {
  emit noted(tr("The recording has stopped"));
}

void TakingAway::showRecorded(const QString& file, double seconds, quint64 lost) {
  QString text =
      tr("Recorded %1 s to %2").arg(formatFixed(seconds, 1), shortName(QFileInfo(file).fileName()));
  if (lost > 0) text += tr("; %1 ticks are missing because the window was busy").arg(lost);
  emit noted(text);
}

}  // namespace nearfit::ui
