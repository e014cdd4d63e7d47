#include "ui/view3d/view_detail.h"

#include <QScreen>
#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include <vtkCamera.h>
#include <vtkPropCollection.h>
#include <vtkRenderWindow.h>

namespace nearfit::ui {
namespace {

using namespace std::chrono_literals;

/// Scenes this small are always drawn in full at once [triangles].
constexpr std::size_t kSmall = 20'000;
/// Drawing this much once everything rests may take half a second [triangles].
constexpr std::size_t kBudgetAtRest = 1'000'000;
/// Drawn whole while a part is felt in the Balanced quality: some 50 ms in software OpenGL [triangles].
constexpr std::size_t kBalanced = 150'000;
constexpr std::size_t kFirstBudget = 60'000, kMinBudget = 30'000, kMaxBudget = 50'000'000;
/// A picture that takes longer is drawn coarser next time, one that takes less finer [ms]. Software OpenGL
/// needs another 10 ms to bring it to the screen.
constexpr qint64 kSlow = 36, kQuick = 15;
constexpr int kStillMs = 150, kDetailRestMs = 220;
/// Time for the kept picture before events are handled again.
constexpr std::chrono::microseconds kTurn = 15ms;

}  // namespace

ViewDetail::ViewDetail(CachingRenderer& renderer, vtkRenderer& overlay, SceneRenderer& parts, QObject* parent)
    : QObject(parent), renderer_(renderer), overlay_(overlay), parts_(parts), budget_(kFirstBudget) {
  for (QTimer* timer : {&still_, &resting_, &next_, &filling_, &compiling_})
    timer->setSingleShot(true);
  still_.setInterval(kStillMs);
  resting_.setInterval(kDetailRestMs);
  next_.setInterval(0);
  filling_.setInterval(0);
  compiling_.setInterval(0);
  connect(&still_, &QTimer::timeout, this, &ViewDetail::beginKeeping);
  connect(&resting_, &QTimer::timeout, this, &ViewDetail::rest);
  connect(&next_, &QTimer::timeout, this, &ViewDetail::keepMore);
  connect(&filling_, &QTimer::timeout, this, &ViewDetail::fillMore);
  connect(&compiling_, &QTimer::timeout, this, &ViewDetail::compileMore);
}

void ViewDetail::setBudget(std::size_t triangles) {
  budget_ = triangles;
  isBudgetFixed_ = true;
}

ViewDetail::Key ViewDetail::key() const {
  vtkCamera* camera = renderer_.GetActiveCamera();
  const int* size = renderer_.GetSize();
  Key key{static_cast<double>(parts_.revision()),
          static_cast<double>(size[0]),
          static_cast<double>(size[1]),
          camera->GetViewAngle(),
          camera->GetParallelScale(),
          static_cast<double>(camera->GetParallelProjection()),
          renderer_.GetBackground()[0]};
  std::copy_n(camera->GetPosition(), 3, key.begin() + 7);
  std::copy_n(camera->GetFocalPoint(), 3, key.begin() + 10);
  std::copy_n(camera->GetViewUp(), 3, key.begin() + 13);
  return key;
}

void ViewDetail::drop() {
  isKeeping_ = false;
  keptKey_.reset();
  toKeep_.clear();
  renderer_.dropKept();
  parts_.letGoOfKept();
}

void ViewDetail::beforePicture() {
  picture_.start();
  const Key now = key();
  if (keptKey_ && *keptKey_ != now) drop();
  // Translucent parts cannot be kept. The last picture at rest shows more of them, and need not be full.
  const bool isLast = isAtRest_ && renderer_.hasKept() && !parts_.hasLoose();
  const std::size_t budget = std::max(budget_, budgetOfFeeling());
  const bool showsAll = std::exchange(showsAllNext_, false);
  // Pictures that draw much else already leave even the last few to the turns between them.
  const NewPartLimits newLimits = isFilling_ ? NewPartLimits{} : fillLimits_.atOnce;
  const DetailChoice choice = parts_.applyDetail({isLast ? std::max(budget, kBudgetAtRest) : budget},
                                                 showsAll ? std::nullopt : std::optional(newLimits));
  isFilling_ = parts_.isHoldingBack();
  detail_ = {choice.triangles, renderer_.hasKept(), choice.isExact};
  isLimited_ = !choice.isExact;
  // A coarse picture is drawn again at rest, so smoothing waits until then.
  const bool isSmooth = isAtRest_ || (choice.isExact && choice.triangles <= kSmall && !detail_.isKept);
  smooth(isSmooth);
  // While something moves, translucent parts are blended in the order they are drawn.
  renderer_.setManyColoured(isSmooth && parts_.hasTranslucent());
  detail_.isFull = detail_.isFull && isSmooth && !isFilling_;
  isAtRest_ = false;
  isFinal_ = detail_.isFull || (isLast && !isFilling_);
  // Only a change that would spoil the kept picture restarts the wait for it; changes drawn over it do not.
  if (isFinal_ || isFilling_ || key_ != now) still_.stop();
  resting_.stop();
  key_ = now;
}

void ViewDetail::smooth(bool isSmooth) {
  // Only one layer per picture: smoothing the last one smooths those under it too.
  vtkPropCollection* props = overlay_.GetViewProps();
  bool hasOverlay = false;
  vtkCollectionSimpleIterator it;
  props->InitTraversal(it);
  while (vtkProp* prop = props->GetNextProp(it))
    hasOverlay = hasOverlay || prop->GetVisibility() != 0;
  renderer_.SetUseFXAA(isSmooth && !hasOverlay);
  overlay_.SetUseFXAA(isSmooth && hasOverlay);
}

void ViewDetail::afterPicture() {
  sincePicture_.start();
  if (!std::exchange(hasDrawn_, true)) compiling_.start();
  if (detail_.triangles > kSmall && !detail_.isFull) adaptBudget();
  // The rest waits for all parts.
  if (isFilling_) return filling_.start();
  if (isFinal_) return;
  // Start counting now: drawing may take longer than these times, and only later events count as motion.
  resting_.start();
  if (!still_.isActive() && !holdsDepths()) still_.start();
}

std::size_t ViewDetail::budgetOfFeeling() const noexcept {
  if (!isFeeling_ || quality_ == FeelQuality::Fast) return 0;
  return quality_ == FeelQuality::Full ? std::numeric_limits<std::size_t>::max() : kBalanced;
}

void ViewDetail::adaptBudget() {
  // What was chosen for feeling says nothing of other motion.
  if (isBudgetFixed_ || budgetOfFeeling() > budget_) return;
  renderer_.GetRenderWindow()->WaitForCompletion();
  const qint64 took = picture_.elapsed();
  if (took > kSlow && 2 * detail_.triangles > budget_) budget_ = std::max(kMinBudget, budget_ / 4 * 3);
  // While parts are still to come, a quick picture says nothing of the next.
  if (took < kQuick && isLimited_ && !isFilling_) budget_ = std::min(kMaxBudget, budget_ / 3 * 4);
}

void ViewDetail::beginKeeping() {
  drop();
  emit depthsNeeded();
  toKeep_ = parts_.keep();
  kept_ = 0;
  keptKey_ = key_ = key();
  isKeeping_ = true;
  renderer_.beginKeeping();
  next_.start();
}

void ViewDetail::keepMore() {
  if (!isKeeping_) return;
  if (key() != *keptKey_) return drop();
  parts_.prepareKept();
  kept_ += renderer_.keep(std::span(toKeep_).subspan(kept_), kTurn);
  if (kept_ < toKeep_.size()) return next_.start();
  isKeeping_ = false;
  renderer_.finishKeeping();
  parts_.showKept();
  isAtRest_ = !parts_.hasLoose();
  emit pictureWanted();
}

void ViewDetail::compileMore() {
  if (samples_ == nullptr) samples_ = std::make_unique<ShaderSamples>();
  renderer_.prepare([this] { return samples_->next(); }, 0us);
  if (!samples_->isDone()) return compiling_.start();
  samples_.reset();
  areShadersReady_ = true;
}

void ViewDetail::fillMore() {
  renderer_.prepare([this] { return parts_.admitNext(); }, fillLimits_.turn);
  if (parts_.isHoldingBack() && sincePicture_.elapsed() < fillLimits_.betweenPictures.count())
    return filling_.start();
  emit pictureWanted();
}

bool ViewDetail::isSettled() const {
  return !isKeeping_ && !isAtRest_ && !isFilling_ && !still_.isActive() && !resting_.isActive();
}

void ViewDetail::rest() {
  if (isKeeping_) return;
  if (parts_.hasLoose() || !renderer_.hasKept()) {
    parts_.settle();
    beginKeeping();
    return;
  }
  isAtRest_ = true;
  emit pictureWanted();
}

void ViewDetail::complete() {
  if (detail_.isFull) return showAllNext();
  completeAnew();
}

void ViewDetail::showAllNext() {
  parts_.makeShapes();
  parts_.makeShapes();
  filling_.stop();
  showsAllNext_ = true;
}

void ViewDetail::completeAnew() {
  showAllNext();
  parts_.admitAll();
  parts_.settle();
  beginKeeping();
  while (isKeeping_)
    keepMore();
}

void PicturePace::request() {
  if (hasRequest_) return;
  hasRequest_ = true;
  const QScreen* screen = view_.window()->screen();
  const auto interval = static_cast<qint64>(1000.0 / std::max(30.0, screen->refreshRate()));
  const qint64 since = sincePicture_.isValid() ? sincePicture_.elapsed() : interval;
  QTimer::singleShot(static_cast<int>(std::max<qint64>(0, interval - since)), Qt::PreciseTimer, this, [this] {
    hasRequest_ = false;
    if (view_.isVisible()) emit pictureDue();
  });
}

}  // namespace nearfit::ui
