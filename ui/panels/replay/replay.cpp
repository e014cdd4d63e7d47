#include "ui/panels/replay/replay.h"

#include <QAction>
#include <QFileDialog>
#include <QFileInfo>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
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
constexpr int kEveryMs = 16;

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
      open_(makeAction(this, "openRecording", tr("&Play a recording…"), QStringLiteral("start"),
                       QStringLiteral("Shift+F8"))),
      shown_(std::make_unique<ServoSnapshot>()) {
  timer_.setTimerType(Qt::PreciseTimer);
  timer_.setInterval(kEveryMs);
  connect(&timer_, &QTimer::timeout, this, &Replay::goOn);
  open_->setToolTip(tr("Play a recorded motion, with a timeline to go back and forth"));
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
      QFileDialog::getOpenFileName(window_, tr("Open recording"), Preferences::lastFolder(),
                                   tr("Recordings of nearfit and nearfit-cli (*.csv);;All files (*)"));
  if (!file.isEmpty()) open(file);
}

void Replay::open(const QString& file) {
  if (task_.isRunning() || hand_.status().isTaken()) return;
  if (!session_.scene().movingPart()) {
    emit failed({tr("The recording cannot be played."),
                 tr("No part is in hand. Take in hand the part that was recorded.")});
    return;
  }
  close();
  Preferences::rememberFolderOf(file);
  auto read = std::make_shared<Recording>();
  progress_ = new ProgressDialog(tr("Reading"), tr("Reading %1").arg(QFileInfo(file).fileName()), window_);
  connect(&task_, &BackgroundTask::progressed, progress_, &ProgressDialog::setFraction);
  connect(progress_, &ProgressDialog::cancelled, &task_, &BackgroundTask::cancel);
  const auto job = [read, path = toPath(file)](const ProgressCallback& progress) {
    *read = readRecording(path, progress);
  };
  task_.run(job, [this, read, file](const std::exception_ptr& error) {
    delete progress_;
    if (!error) {
      if (read->isCut)
        emit noted(tr("The recording is incomplete: its last whole row is at %1 s")
                       .arg(read->rows.back().time, 0, 'f', 3));
      return begin(file, std::move(read->rows));
    }
    if (!isCancelled(error)) emit failed(describe(tr("The recording could not be opened."), error));
  });
}

void Replay::begin(const QString& file, std::vector<MotionRow> rows) {
  // The moving part may be gone, or in hand, meanwhile.
  if (hand_.status().isTaken() || !session_.scene().movingPart()) return;
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
  view_.poses().show(ShownPoses::Source::Replay, {});
  view_.clearSnapshot();
  emit closed();
  guard_.setReplaying(false);
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
