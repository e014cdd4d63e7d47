#include "ui/panels/suggest/path_suggestion.h"

#include <QAction>
#include <QFileInfo>
#include <QWidget>
#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/files/atomic_write.h"
#include "core/files/sha256.h"
#include "core/parallel/low_priority.h"
#include "core/path/certificate.h"
#include "core/path/path_file.h"
#include "core/scene/drawn_pose.h"
#include "core/scene/moving_body.h"
#include "ui/model/hand_state.h"
#include "ui/panels/suggest/suggestion_card.h"
#include "ui/view3d/mark_actors.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/format.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/progress_dialog.h"
#include "ui/widgets/save_file.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// One step for each picture of a 60 Hz display.
constexpr int kGhostMs = 16;
/// The ghost goes all the way in at most this time, and rests at the end before it begins again [s].
constexpr double kMaxPlayTime = 8.0, kRest = 1.0;
/// Share of the progress that finding where a part was drawn takes: it may read a document.
constexpr double kDrawnFound = 0.1;
/// Width of the line that shows the path, and of the dots at its ends: thinner than the ghost's line, which lies on it
/// [device-independent pixels].
constexpr float kWayWidth = 2.0F, kWayEnd = 8.0F;
/// From the card to the view's upper left corner: what is in hand is in the middle, the legend below, the marker of the
/// axes on the right [pixels].
constexpr int kCardFromCorner = 14;

QString nameOfMoving(const Scene& scene) {
  if (scene.movingGroup()) return QString::fromStdString(scene.findGroup(*scene.movingGroup())->name);
  return QString::fromStdString(scene.get(*scene.movingPart()).name);
}

}  // namespace

struct PathSuggestion::Search {
  Scene scene;
  SuggestionRequest request;
  PathGoal goal;
  PathSearchResult result;

  void run(const ProgressCallback& progress) {
    if (request.goal == SuggestionRequest::Goal::ToDrawn)
      goal.pose = drawnPose(scene, *scene.movingPart(), stageCallback(progress, 0.0, kDrawnFound));
    PathSearchOptions options;
    options.separation = request.separation;
    options.seconds = request.seconds;
    options.mayTurn = request.mayTurn;
    result = searchPath(scene, goal, options, stageCallback(progress, kDrawnFound, 1.0));
  }
};

PathSuggestion::PathSuggestion(const Context& context, QWidget* window)
    : QObject(window),
      session_(context.session),
      hand_(context.hand),
      view_(context.view),
      window_(window),
      action_(
          makeAction(this, "suggestPath", tr("Suggest path…"), {}, {},
                     tr("Look for a way of what is in hand to where it was drawn, or out of the assembly"))),
      ghost_(std::make_unique<ServoSnapshot>()),
      way_(std::make_unique<MarkActors>(view_.overlay(), MarkActors::Look{1.0, kWayWidth, kWayEnd})) {
  way_->setColours(colours::kHand, colours::kHand);
  timer_.setTimerType(Qt::PreciseTimer);
  timer_.setInterval(kGhostMs);
  connect(&timer_, &QTimer::timeout, this, &PathSuggestion::play);
  connect(action_, &QAction::triggered, this, &PathSuggestion::askAndSearch);
  connect(&hand_, &HandState::changed, this, &PathSuggestion::update);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { followSession(); });
  update();
}

PathSuggestion::~PathSuggestion() = default;

void PathSuggestion::askAndSearch() {
  emit sceneNeeded();
  const Scene& scene = session_.scene();
  if (task_.isRunning() || hand_.status().isTaken() || !scene.movingPart()) return;
  try {
    const double separation = defaultSeparation(scene, pathFrame(scene));
    const auto request = askForSuggestion(nameOfMoving(scene), separation, window_);
    if (request && session_.scene().movingPart()) search(*request);
  } catch (...) {
    emit failed(describe(tr("A path cannot be searched."), std::current_exception()));
  }
}

void PathSuggestion::search(const SuggestionRequest& request) {
  close();
  const auto search = std::make_shared<Search>();
  search->scene = session_.scene();
  search->request = request;
  sceneSerial_ = session_.sceneSerial();
  stateSerial_ = session_.stateSerial();
  moving_ = *search->scene.movingPart();
  movingGroup_ = search->scene.movingGroup();
  const auto job = [search](const ProgressCallback& progress) {
    // The view goes first, and a servo.
    lowerThreadPriority();
    search->run(progress);
  };
  const QString text = tr("Looking for a path of %1").arg(shortName(nameOfMoving(search->scene)));
  runWithDialog(task_, tr("Searching"), text, window_, job, [this, search](const std::exception_ptr& error) {
    update();
    if (!error) return show(search);
    if (isCancelled(error)) return emit noted(tr("The search was cancelled"));
    emit failed(describe(tr("No path could be searched."), error));
  });
  update();
}

void PathSuggestion::show(const std::shared_ptr<const Search>& search) {
  const Scene& scene = session_.scene();
  // It may have been put down, or another scene opened, meanwhile.
  if (session_.sceneSerial() != sceneSerial_ || scene.movingPart() != moving_ ||
      scene.movingGroup() != movingGroup_)
    return emit noted(tr("The path that was searched is of what is no longer in hand"));
  const bool isFound = search->result.end == PathSearchEnd::Found;
  if (isFound) {
    path_ = std::make_shared<const AssemblyPath>(search->result.path);
    found_ = search;
  }
  const std::string text = describePathSearch(search->scene, search->goal, search->result, [](double length) {
    return formatLength(length).toStdString();
  });
  card_ = new SuggestionCard(QString::fromStdString(text), isFound, window_);
  connect(card_, &SuggestionCard::saveWanted, this, &PathSuggestion::save);
  connect(card_, &SuggestionCard::certificateWanted, this, &PathSuggestion::saveCertificate);
  card_->setCertifiable(isCertifiable());
  connect(card_, &SuggestionCard::guidanceWanted, this, &PathSuggestion::guide);
  connect(card_, &QDialog::finished, this, &PathSuggestion::close);
  card_->move(view_.mapToGlobal(QPoint(kCardFromCorner, kCardFromCorner)));
  card_->show();
  if (isFound) drawWay();
  sincePlay_.restart();
  update();
}

void PathSuggestion::close() {
  if (card_) {
    card_->disconnect(this);
    card_->close();
  }
  card_ = nullptr;
  if (!path_) return;
  const bool isShown = timer_.isActive();
  timer_.stop();
  path_.reset();
  found_.reset();
  way_->clear();
  if (isShown) view_.clearSnapshot();
  view_.requestRender();
  if (std::exchange(isGuiding_, false)) emit guidanceChanged(nullptr);
}

void PathSuggestion::save() {
  const std::optional<QString> file =
      askForSave({tr("Save path"),
                  Preferences::lastFolder() + QStringLiteral("/suggested.nfpath"),
                  {tr("Paths (*.nfpath)")},
                  {QStringLiteral("nfpath")}},
                 window_);
  if (!file || !path_) return;
  Preferences::rememberFolderOf(*file);
  try {
    writePathFile(*path_, toPath(*file));
  } catch (...) {
    return emit failed(describe(tr("The path could not be saved."), std::current_exception()));
  }
  emit noted(tr("Saved the path to %1").arg(shortName(QFileInfo(*file).fileName())));
}

bool PathSuggestion::isCertifiable() const {
  return found_ != nullptr && session_.stateSerial() == stateSerial_ && !task_.isRunning();
}

void PathSuggestion::saveCertificate() {
  const std::optional<QString> file =
      askForSave({tr("Save certificate"),
                  Preferences::lastFolder() + QStringLiteral("/suggested.nfcert"),
                  {tr("Certificates (*.nfcert)")},
                  {QStringLiteral("nfcert")}},
                 window_);
  if (!file || !isCertifiable()) return;
  const bool isSaved = !session_.file().empty() && !session_.isModified();
  const auto job = [found = found_, to = toPath(*file),
                    scene = isSaved ? session_.file() : std::filesystem::path()](const ProgressCallback&) {
    lowerThreadPriority();
    const std::string sceneSha256 = scene.empty() ? std::string() : sha256OfFile(scene);
    atomicWrite(to, certificateText(
                        certificateOf(found->scene, found->result.path, found->result.proof, sceneSha256)));
  };
  runWithDialog(task_, tr("Writing"), tr("Writing the certificate"), window_, job,
                [this, file = *file](const std::exception_ptr& error) {
                  update();
                  if (error && isCancelled(error)) return;
                  if (error) return emit failed(describe(tr("The certificate could not be saved."), error));
                  Preferences::rememberFolderOf(file);
                  emit noted(tr("Saved the certificate to %1").arg(shortName(QFileInfo(file).fileName())));
                });
  update();
}

void PathSuggestion::guide(bool isOn) {
  if (!path_) return;
  isGuiding_ = isOn;
  emit guidanceChanged(isOn ? path_ : nullptr);
  if (!isOn) return;
  // Keys that move the hand go to whatever has the focus: not to the card.
  window_->activateWindow();
  view_.setFocus();
  emit feelRequested();
}

void PathSuggestion::drawWay() {
  MarkCells faces, line, ends;
  std::vector<glm::dvec3> places;
  for (const GuidancePose& pose : wayOf(*path_, massOfMoving(session_.scene()).properties.centre))
    places.push_back(pose.place);
  if (places.size() > 1) line.add(places);
  ends.add({places.front()});
  ends.add({places.back()});
  way_->show(faces, line, ends);
  view_.requestRender();
}

void PathSuggestion::update() {
  const bool isTaken = hand_.status().isTaken();
  action_->setEnabled(!isTaken && !task_.isRunning() && session_.scene().movingPart().has_value());
  if (card_) card_->setCertifiable(isCertifiable());
  const bool isPlaying = path_ != nullptr && !isTaken;
  if (isPlaying == timer_.isActive()) return;
  if (isPlaying) {
    sincePlay_.restart();
    timer_.start();
  } else {
    // While the part is felt, the view shows the hand's own ghost.
    timer_.stop();
  }
}

void PathSuggestion::followSession() {
  const Scene& scene = session_.scene();
  if (path_ && (session_.sceneSerial() != sceneSerial_ || scene.movingPart() != moving_ ||
                scene.movingGroup() != movingGroup_))
    close();
  update();
}

void PathSuggestion::play() {
  const Scene& scene = session_.scene();
  const Part* part = scene.find(moving_);
  if (part == nullptr || !path_) return;
  const double begin = path_->poses.front().time, length = path_->poses.back().time - begin;
  const double speed = std::max(1.0, length / kMaxPlayTime), lasts = length / speed;
  const double passed = std::fmod(1e-3 * static_cast<double>(sincePlay_.elapsed()), lasts + kRest);
  const double time = begin + speed * std::min(passed, lasts);
  ServoSnapshot& ghost = *ghost_;
  ghost.moving = moving_;
  ghost.proxy = part->worldFromPart;
  ghost.handle = poseAt(*path_, placeAt(*path_, time));
  ghost.centre = ghost.proxy.applyToPoint(massOfMoving(scene).properties.centre);
  ghost.distance = std::numeric_limits<double>::infinity();
  ghost.time = time;
  view_.showGhost(ghost);
}

}  // namespace nearfit::ui
