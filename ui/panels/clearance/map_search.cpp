#include "ui/panels/clearance/map_search.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "ui/model/hand_state.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"

namespace nearfit::ui {
namespace {

/// Shortest time between the starts of two maps [ms].
constexpr int kMapEveryMs = 120;
/// Time without motion after which a large map is computed [ms].
constexpr int kRestMs = 250;
/// Age of a change at which the colours are marked as old [ms].
constexpr int kLateMs = 400;
/// Progress when clearances are known, and only drawing is to be prepared.
constexpr double kMeasured = 0.9;

void setUpOnce(QTimer& timer, int milliseconds) {
  timer.setSingleShot(true);
  timer.setInterval(milliseconds);
}

}  // namespace

ClearanceMapSearch::ClearanceMapSearch(const Context& context, QObject* parent)
    : QObject(parent), context_(context), sceneSerial_(context.session.sceneSerial()) {
  setUpOnce(pace_, kMapEveryMs);
  setUpOnce(rest_, kRestMs);
  setUpOnce(late_, kLateMs);
  connect(&pace_, &QTimer::timeout, this, &ClearanceMapSearch::startIfDue);
  connect(&rest_, &QTimer::timeout, this, &ClearanceMapSearch::startIfDue);
  connect(&late_, &QTimer::timeout, this, [this] { setStale(true); });
  connect(&task_, &BackgroundTask::progressed, this, &ClearanceMapSearch::progressed);
  connect(&context_.selection, &Selection::changed, this, &ClearanceMapSearch::followSubject);
  connect(&context_.poses, &ShownPoses::changed, this, &ClearanceMapSearch::followParts);
  changes_ = context_.session.onChange(SceneEvents::Stage::Panels, [this] {
    // In another scene the same id means another part.
    if (std::exchange(sceneSerial_, context_.session.sceneSerial()) != context_.session.sceneSerial()) drop();
    followSubject();
    followParts();
  });
}

std::vector<PartId> ClearanceMapSearch::subject() const {
  return mapSubject(context_.session.scene(), context_.selection.parts());
}

void ClearanceMapSearch::setWanted(bool isWanted) {
  if (isWanted == std::exchange(isWanted_, isWanted)) return;
  if (isWanted) {
    subject_ = subject();
    return refresh();
  }
  task_.cancel();
  drop();
}

void ClearanceMapSearch::setRange(double range) {
  if (std::exchange(range_, range) != range) refresh();
}

void ClearanceMapSearch::setNearParts(bool hasNearParts) {
  if (std::exchange(hasNearParts_, hasNearParts) != hasNearParts) refresh();
}

void ClearanceMapSearch::cancel() {
  if (!task_.isRunning()) return;
  isCancelled_ = true;
  isDue_ = false;
  rest_.stop();
  late_.stop();
  task_.cancel();
  setStale(true);
}

void ClearanceMapSearch::refresh() {
  if (!isWanted_) return;
  isDue_ = true;
  isCancelled_ = false;
  late_.start();
  // The map being computed is not wanted any more.
  if (task_.isRunning()) return task_.cancel();
  rest_.stop();
  startIfDue();
}

bool ClearanceMapSearch::isLive() const {
  if (shown_ != nullptr) return shown_->map.samples() <= kMaxLiveSamples;
  // The first map tells; it has its vertices at least.
  std::size_t vertices = 0;
  for (const PartId id : subject_) {
    const Part* part = context_.session.scene().find(id);
    if (part == nullptr) return false;
    vertices += part->geometry->mesh.vertices().size();
  }
  return !subject_.empty() && vertices <= kMaxLiveSamples;
}

ClearanceMapRequest ClearanceMapSearch::present() const {
  const Scene& scene = context_.session.scene();
  ClearanceMapRequest request = clearanceMapRequest(scene, subject_, range_, hasNearParts_);
  for (MeasuredPart& part : request.parts)
    part.worldFromPart = context_.poses.poseOf(scene.get(part.id));
  return request;
}

void ClearanceMapSearch::followParts() {
  // Names, colours and settings do not matter, nor does where a move is only proposed.
  const auto isSame = [](const MeasuredPart& a, const MeasuredPart& b) {
    return a.id == b.id && a.geometry == b.geometry && a.worldFromPart == b.worldFromPart;
  };
  // Poses may be told of before a subject that has left or changed is.
  if (!isWanted_ || subject_.empty() || subject_ != subject()) return;
  if (!std::ranges::equal(present().parts, begun_, isSame)) request();
}

void ClearanceMapSearch::followSubject() {
  const std::vector<PartId> before = std::exchange(subject_, subject());
  if (!isWanted_ || subject_ == before) return;
  drop();
  refresh();
}

void ClearanceMapSearch::drop() {
  late_.stop();
  automaticRange_ = 0.0;
  begun_.clear();
  if (shown_ == nullptr && !isStale_) return;
  shown_ = nullptr;
  isStale_ = false;
  emit changed();
}

void ClearanceMapSearch::request() {
  isDue_ = true;
  isCancelled_ = false;
  if (isLive()) {
    if (!late_.isActive() && !isStale_) late_.start();
    return startIfDue();
  }
  // It takes too long to follow: begin once nothing moves any more, rather than with a pose that is soon old.
  setStale(shown_ != nullptr);
  if (task_.isRunning()) task_.cancel();
  rest_.start();
}

void ClearanceMapSearch::startIfDue() {
  const bool mustWait = task_.isRunning() || pace_.isActive() || (rest_.isActive() && !isLive());
  // Whatever it waits for calls this when it ends.
  if (isDue_ && isWanted_ && !mustWait) start();
}

void ClearanceMapSearch::start() {
  isDue_ = false;
  rest_.stop();
  if (subject_.empty()) return drop();
  ClearanceMapRequest request = present();
  begun_ = request.parts;
  request.keptRange = automaticRange_;
  // The servo and its search ahead keep a processor.
  request.isParallel = !context_.hand.part();
  auto found = std::make_shared<ShownMap>();
  const auto job = [mapper = mapper_, request = std::move(request), found](const ProgressCallback& progress) {
    found->subject = request.subject;
    found->isAutomatic = request.range == 0.0;
    found->map = mapper->map(request, stageCallback(progress, 0.0, kMeasured));
    found->areas = AreaByClearance(found->map.subject());
    for (const MappedSurface& mapped : found->map.surfaces)
      found->colours[mapped.part] = colouredSurface(mapped, found->map.range);
  };
  running_.start();
  pace_.start(kMapEveryMs);
  task_.run(job, [this, found](const std::exception_ptr& error) { finish(found, error); });
  emit workChanged();
}

void ClearanceMapSearch::finish(const std::shared_ptr<const ShownMap>& found,
                                const std::exception_ptr& error) {
  if (!isWanted_) return emit workChanged();
  // Rest as long as it took, so that whatever else runs while a part is felt gets its share.
  if (context_.hand.part()) pace_.start(std::max<int>(kMapEveryMs, static_cast<int>(running_.elapsed())));
  if (!error && subject_ == found->subject) {
    shown_ = found;
    automaticRange_ = found->isAutomatic ? found->map.range : 0.0;
    // During motion it is always of a pose that is a little old.
    late_.stop();
    if (isDue_) late_.start();
    isStale_ = isCancelled_ = false;
    emit changed();
  } else if (error && !nearfit::isCancelled(error)) {
    setStale(shown_ != nullptr);
    emit failed(describe(tr("The map of clearance could not be computed."), error));
  }
  emit workChanged();
  startIfDue();
}

void ClearanceMapSearch::setStale(bool isStale) {
  if (shown_ == nullptr) isStale = false;
  if (std::exchange(isStale_, isStale) != isStale) emit changed();
}

}  // namespace nearfit::ui
