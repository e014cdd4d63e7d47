#include "ui/panels/replay/replay.h"

#include <QAction>
#include <QFileDialog>
#include <QFileInfo>
#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/path/path_file.h"
#include "core/path/path_rows.h"
#include "core/scene/moving_body.h"
#include "core/servo/motion_reader.h"
#include "ui/model/hand_state.h"
#include "ui/model/move_guard.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/replay/timeline.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/format.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/progress_dialog.h"

namespace nearfit::ui {
namespace {

/// One step for each picture of a 60 Hz display.
constexpr int kFrameMs = 16;
/// Rows that play a path: as many pictures a second, but no more than are measured and drawn at once.
constexpr double kPathStep = 1.0 / 60.0;
constexpr std::size_t kMaxPathRows = 4000;

/// Content of a recording or path file.
struct OpenedMotion {
  Recording recording;
  std::optional<AssemblyPath> path;
};

OpenedMotion readMotionFile(const std::filesystem::path& file, const ProgressCallback& progress) {
  OpenedMotion opened;
  if (isJsonFile(file)) {
    opened.path = readPathFile(file);
    opened.recording.rows = rowsOfPath(sampledPath(*opened.path, kPathStep, kMaxPathRows));
  } else {
    opened.recording = readRecording(file, progress);
  }
  return opened;
}

QString noteOf(const MotionRow& row) {
  return QObject::tr("Force %1    Torque %2    Clearance %3    Contacts %4")
      .arg(formatForce(glm::length(row.wrench.force)), formatTorque(glm::length(row.wrench.torque)),
           formatDistance(row.distance, row.isDistanceBound))
      .arg(row.contacts);
}

}  // namespace

Replay::Replay(const Context& context, Timeline& timeline, QWidget* window)
    : QObject(window),
      session_(context.session),
      hand_(context.hand),
      guard_(context.guard),
      view_(context.view),
      timeline_(timeline),
      window_(window),
      open_(makeAction(this, "openRecording", tr("&Play a recording or path…"), QStringLiteral("start"),
                       QStringLiteral("Shift+F8"))),
      shown_(std::make_unique<ServoSnapshot>()) {
  timer_.setTimerType(Qt::PreciseTimer);
  timer_.setInterval(kFrameMs);
  connect(&timer_, &QTimer::timeout, this, &Replay::goOn);
  setHelp(*open_, tr("Play a recorded motion or a path, with a timeline to go back and forth"));
  connect(open_, &QAction::triggered, this, &Replay::askAndOpen);
  connectTimeline();
  connect(&hand_, &HandState::changed, this, &Replay::followHand);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { followSession(); });
}

Replay::~Replay() = default;

void Replay::connectTimeline() {
  connect(&timeline_, &Timeline::openWanted, this, &Replay::askAndOpen);
  connect(&timeline_, &Timeline::closeWanted, this, &Replay::close);
  connect(&timeline_, &Timeline::playToggled, this, [this] { setPlaying(!timer_.isActive()); });
  connect(&timeline_, &Timeline::sought, this, &Replay::seek);
  connect(&timeline_, &Timeline::stepped, this, [this](int rows) {
    if (!playback_) return;
    setPlaying(false);
    playback_->step(rows);
    show();
  });
  connect(&timeline_, &Timeline::speedChosen, this, [this](double speed) {
    if (playback_) playback_->setSpeed(speed);
  });
  connect(&timeline_, &Timeline::loopingChosen, this, [this](bool isLooping) {
    if (playback_) playback_->setLooping(isLooping);
  });
}

void Replay::askAndOpen() {
  const QString file =
      QFileDialog::getOpenFileName(window_, tr("Open recording or path"), Preferences::lastFolder(),
                                   tr("Recordings and paths of nearfit and nearfit-cli (*.csv *.nfpath);;"
                                      "All files (*)"));
  if (!file.isEmpty()) open(file);
}

void Replay::open(const QString& file) {
  if (task_.isRunning() || hand_.status().isTaken()) return;
  if (!session_.scene().movingPart()) {
    emit failed(
        {tr("The recording cannot be played."), tr("No part is in hand. Take in hand the part that moved.")});
    return;
  }
  close();
  Preferences::rememberFolderOf(file);
  auto read = std::make_shared<OpenedMotion>();
  const auto job = [read, path = toPath(file)](const ProgressCallback& progress) {
    *read = readMotionFile(path, progress);
  };
  const QString text = tr("Reading %1").arg(QFileInfo(file).fileName());
  const auto done = [this, read, file](const std::exception_ptr& error) {
    if (!error) {
      if (read->recording.isCut)
        emit noted(tr("The recording is incomplete: its last whole row is at %1 s")
                       .arg(read->recording.rows.back().time, 0, 'f', 3));
      return begin(file, std::move(read->recording.rows), std::move(read->path));
    }
    if (!isCancelled(error)) emit failed(describe(tr("The recording could not be opened."), error));
  };
  runWithDialog(task_, tr("Reading"), text, window_, job, done);
}

QString Replay::refusalOf(const AssemblyPath& path) const {
  const Scene& scene = session_.scene();
  const QString lead = QString::fromStdString(path.parts.front());
  const Part* part = scene.findByName(path.parts.front());
  if (part == nullptr) return tr("The path moves “%1”, which is not in the scene.").arg(lead);
  const bool isLead = scene.movingPart() == part->id;
  const bool areInHand = std::ranges::all_of(path.parts, [&scene](const std::string& name) {
    const Part* each = scene.findByName(name);
    return each != nullptr && scene.isMoving(each->id);
  });
  const bool isMore = path.parts.size() == 1 && scene.movingParts().size() > 1;
  if (isLead && areInHand && !isMore) return {};
  return path.parts.size() == 1
             ? tr("The path moves “%1”. Take it in hand to play it.").arg(lead)
             : tr("The path moves “%1” and others as one. Take their group in hand to play it.").arg(lead);
}

void Replay::begin(const QString& file, std::vector<MotionRow> rows, std::optional<AssemblyPath> path) {
  // The moving part may be gone, or in hand, meanwhile.
  if (hand_.status().isTaken() || !session_.scene().movingPart()) return;
  if (path) {
    const QString refusal = refusalOf(*path);
    if (!refusal.isEmpty()) return emit failed({tr("The path cannot be played."), refusal});
  }
  path_ = std::move(path);
  pathFile_ = path_ ? toPath(file) : std::filesystem::path();
  moving_ = *session_.scene().movingPart();
  movingGroup_ = session_.scene().movingGroup();
  playback_.emplace(std::move(rows));
  timeline_.showRecording(QFileInfo(file).fileName(), playback_->rows());
  emit opened(playback_->rows());
  timeline_.setFocus();
  guard_.setReplaying(true);
  show();
  setPlaying(true);
}

void Replay::followHand() {
  const bool isTaken = hand_.status().isTaken();
  open_->setEnabled(!isTaken);
  timeline_.setEnabled(!isTaken);
  if (isTaken) close();
}

void Replay::close() {
  if (!playback_) return;
  timer_.stop();
  // It draws the rows of the playback.
  timeline_.showRecording({}, {});
  playback_.reset();
  path_.reset();
  pathFile_.clear();
  view_.poses().show(ShownPoses::Source::Replay, {});
  view_.clearSnapshot();
  emit closed();
  guard_.setReplaying(false);
}

AssemblyPath Replay::pathBetween(double from, double to) const {
  if (!playback_) throw UsageError("path", "no motion is open", "open a recording or a path");
  const bool isWhole = from <= 0.0 && to >= playback_->duration();
  if (!path_) {
    return isWhole ? pathOfMotion(playback_->rows(), session_.scene())
                   : pathOfMotion(playback_->rows(), session_.scene(), from, to);
  }
  return isWhole ? *path_ : trimmed(*path_, startTime() + from, startTime() + to);
}

void Replay::goTo(double time) {
  setPlaying(false);
  seek(time);
}

AssemblyPath Replay::playedPath() const {
  return sampledPath(*path_, kPathStep, kMaxPathRows);
}

void Replay::showClearances(const std::vector<PathClearance>& clearances) {
  if (!playback_ || !path_) return;
  std::vector<MotionRow> rows = playback_->rows();
  setDistances(rows, clearances);
  MotionPlayback next(std::move(rows));
  next.setSpeed(playback_->speed());
  next.setLooping(playback_->isLooping());
  next.seek(playback_->time());
  // The timeline draws the rows of the playback.
  timeline_.showRows({});
  playback_.emplace(std::move(next));
  timeline_.showRows(playback_->rows());
  emit rowsChanged(playback_->rows());
  show();
}

void Replay::setPlaying(bool isPlaying) {
  if (!playback_) return;
  // At the end there is nothing more to play: begin again.
  if (isPlaying && playback_->time() >= playback_->duration()) playback_->seek(0.0);
  isPlaying ? timer_.start() : timer_.stop();
  sinceLast_.restart();
  timeline_.showPlaying(isPlaying);
}

void Replay::seek(double time) {
  if (!playback_) return;
  playback_->seek(time);
  show();
}

void Replay::goOn() {
  const double passed = 1e-3 * static_cast<double>(sinceLast_.restart());
  if (!playback_->advance(passed)) setPlaying(false);
  show();
}

void Replay::show() {
  const Part* part = session_.scene().find(moving_);
  if (part == nullptr) return;
  takeRow(playback_->row(), *part, *shown_);
  timeline_.showTime(playback_->time(), noteOf(playback_->row()));
  const Scene& scene = session_.scene();
  shown_->centre = shown_->proxy.applyToPoint(massOfMoving(scene).properties.centre);
  view_.poses().show(ShownPoses::Source::Replay, movedPoses(scene, shown_->proxy));
  view_.showSnapshot(*shown_);
  emit timeShown(shown_->time);
  emit rowShown(*shown_);
}

void Replay::followSession() {
  const Scene& scene = session_.scene();
  if (playback_ && (scene.movingPart() != moving_ || scene.movingGroup() != movingGroup_)) close();
}

}  // namespace nearfit::ui
