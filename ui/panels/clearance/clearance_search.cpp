#include "ui/panels/clearance/clearance_search.h"

#include <memory>
#include <utility>

#include "core/report/mesh_export.h"

namespace nearfit::ui {
namespace {

/// Shortest time between the starts of two searches, which leaves processors for a drag or the servo.
constexpr int kEveryMs = 250;

}  // namespace

ClearanceSearch::ClearanceSearch(Session& session, PoseOfMoving poseOfMoving, QObject* parent)
    : QObject(parent), session_(session), poseOfMoving_(std::move(poseOfMoving)) {
  timer_.setSingleShot(true);
  timer_.setInterval(kEveryMs);
  connect(&timer_, &QTimer::timeout, this, [this] {
    if (isDue_) search();
  });
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { request(); });
}

void ClearanceSearch::setWanted(bool isWanted) {
  if (isWanted == std::exchange(isWanted_, isWanted)) return;
  isWanted ? request() : task_.cancel();
}

void ClearanceSearch::setSubject(std::optional<PartId> part) {
  chosen_ = part;
  clearances_.clear();
  emit changed();
  request();
}

std::optional<PartId> ClearanceSearch::subject() const {
  return isChosen() ? chosen_ : session_.scene().movingPart();
}

std::vector<PartId> ClearanceSearch::body() const {
  return isChosen() ? std::vector{*chosen_} : session_.scene().movingParts();
}

void ClearanceSearch::showSnapshot(const ServoSnapshot& snapshot) {
  if (!isWanted_) return;
  // A tick knows the minima of a group as a whole.
  const bool isInHand = !isChosen() || !session_.scene().movingGroup();
  if (isInHand && subject() == snapshot.moving) {
    updateFrom(snapshot, clearances_);
    emit changed();
  }
  // The part in hand affects other parts' clearances too, and the servo knows nothing beyond its cutoff.
  followMoving();
}

void ClearanceSearch::followMoving() {
  const RigidTransform pose = poseOfMoving_();
  if (std::exchange(poseShown_, pose) != pose) request();
}

bool ClearanceSearch::isOfPresentPose() const {
  return poseSearched_ == poseOfMoving_();
}

void ClearanceSearch::request() {
  if (!isWanted_) return;
  isDue_ = true;
  if (!timer_.isActive() && !task_.isRunning()) search();
}

void ClearanceSearch::search() {
  // The search that runs asks again when it ends.
  if (task_.isRunning() || !isWanted_) return;
  isDue_ = false;
  timer_.start();
  const std::vector<PartId> parts = body();
  const RigidTransform pose = poseOfMoving_();
  auto scene = std::make_shared<const Scene>(placedScene(session_.scene(), pose));
  if (parts.empty()) return finish(parts, *scene, pose, {}, nullptr);
  auto found = std::make_shared<std::vector<PartClearance>>();
  const double cutoff = scene->haptics().springs.cutoff;
  const auto job = [scene, found, parts, cutoff](const ProgressCallback& progress) {
    *found = clearancesOf(*scene, parts, cutoff, progress);
  };
  task_.run(job, [this, scene, pose, found, parts](const std::exception_ptr& error) {
    finish(parts, *scene, pose, *found, error);
    if (isDue_ && !timer_.isActive()) search();
  });
}

void ClearanceSearch::finish(const std::vector<PartId>& parts, const Scene& scene, const RigidTransform& pose,
                             const std::vector<PartClearance>& found, const std::exception_ptr& error) {
  // Results for a former part, or of a cancelled search: what is due follows.
  if (parts != body() || !isWanted_ || (error && isDue_)) return;
  if (error) {
    emit failed(describe(tr("The clearances could not be computed."), error));
    return;
  }
  searched_ = scene;
  poseSearched_ = pose;
  clearances_ = found;
  emit changed();
}

}  // namespace nearfit::ui
