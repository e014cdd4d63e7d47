#include "ui/panels/verdict/scene_check_run.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "ui/model/shown_poses.h"

namespace nearfit::ui {
namespace {

/// Time after which a motion makes a result old [ms].
constexpr int kOldAfterMs = 250;

bool isSamePart(const CheckedPart& a, const CheckedPart& b) {
  return a.id == b.id && a.geometry == b.geometry && a.worldFromPart == b.worldFromPart;
}

/// True if rules may say something else of the part.
bool isRuledAnew(const CheckedPart& a, const CheckedPart& b) {
  return a.ruled.name != b.ruled.name || a.ruled.group != b.ruled.group;
}

}  // namespace

SceneCheckRun::SceneCheckRun(const Context& context, QObject* parent)
    : QObject(parent), context_(context), sceneSerial_(context.session.sceneSerial()) {
  late_.setSingleShot(true);
  late_.setInterval(kOldAfterMs);
  connect(&late_, &QTimer::timeout, this, &SceneCheckRun::compareWithScene);
  connect(&task_, &BackgroundTask::progressed, this, &SceneCheckRun::progressed);
  connect(&context_.poses, &ShownPoses::changed, this, [this] {
    if (checked_ != nullptr && !late_.isActive()) late_.start();
  });
  changes_ = context_.session.onChange(SceneEvents::Stage::Panels, [this] { followSession(); });
}

SceneCheckRequest SceneCheckRun::present(double threshold) const {
  const Scene& scene = context_.session.scene();
  SceneCheckRequest request = sceneCheckRequest(scene, threshold);
  for (CheckedPart& part : request.parts)
    part.worldFromPart = context_.poses.poseOf(scene.get(part.id));
  // The servo, its search ahead and the view go first.
  request.isLowPriority = true;
  return request;
}

void SceneCheckRun::start(double threshold) {
  if (task_.isRunning()) return;
  isCancelled_ = false;
  const auto checking = std::make_shared<CheckedScene>();
  checking->scene = context_.session.scene();
  checking->request = present(threshold);
  const auto job = [checking](const ProgressCallback& progress) {
    checking->check = checkScene(checking->request, progress);
  };
  task_.run(job, [this, checking, serial = sceneSerial_](const std::exception_ptr& error) {
    // A check may have ended just before another scene was opened.
    serial == sceneSerial_ ? finish(checking, error) : emit workChanged();
  });
  emit workChanged();
}

void SceneCheckRun::cancel() {
  if (!task_.isRunning()) return;
  isCancelled_ = true;
  task_.cancel();
}

void SceneCheckRun::finish(const std::shared_ptr<CheckedScene>& checked, const std::exception_ptr& error) {
  if (error) {
    if (!nearfit::isCancelled(error)) emit failed(describe(tr("The scene could not be checked."), error));
    return emit workChanged();
  }
  // States that the user gave meanwhile count, and parts that came meanwhile were not checked.
  const Scene& scene = checked->scene;
  checked->compared = compareFindings(checked->check, context_.session.scene().pairRecords());
  std::erase_if(checked->compared, [&scene](const ComparedFinding& finding) {
    return scene.find(finding.pair.part) == nullptr || scene.find(finding.pair.other) == nullptr;
  });
  checked_ = checked;
  isStale_ = isCancelled_ = false;
  keep();
  compareWithScene();
  emit changed();
  emit workChanged();
}

void SceneCheckRun::keep() {
  const Scene& scene = context_.session.scene();
  std::vector<PairRecord> records = recordsOf(checked_->compared);
  std::erase_if(records, [&scene](const PairRecord& record) {
    return scene.find(record.pair.part) == nullptr || scene.find(record.pair.other) == nullptr;
  });
  try {
    context_.session.setPairRecords(records);
  } catch (...) {
    emit failed(describe(tr("The findings could not be kept with the scene."), std::current_exception()));
  }
}

void SceneCheckRun::followSession() {
  const std::uint64_t serial = context_.session.sceneSerial();
  if (std::exchange(sceneSerial_, serial) == serial) return compareWithScene();
  // In another scene the same id means another part.
  task_.cancel();
  isCancelled_ = false;
  checked_ = nullptr;
  isStale_ = false;
  emit changed();
  emit workChanged();
}

void SceneCheckRun::compareWithScene() {
  if (checked_ == nullptr) return;
  const std::vector<CheckedPart>& before = checked_->request.parts;
  const SceneCheckRequest now = present(checked_->check.threshold);
  const bool isSame = now.rules == checked_->request.rules &&
                      std::ranges::equal(now.parts, before, isSamePart) &&
                      (now.rules.empty() || std::ranges::none_of(now.parts, [&](const CheckedPart& part) {
                         return isRuledAnew(part, before[static_cast<std::size_t>(&part - now.parts.data())]);
                       }));
  if (std::exchange(isStale_, !isSame) == isSame) emit staleChanged();
}

bool SceneCheckRun::isAsChecked(const PartPair& pair) const {
  if (checked_ == nullptr) return false;
  const auto isSameAs = [this](PartId id) {
    const Part* part = context_.session.scene().find(id);
    const auto before = std::ranges::lower_bound(checked_->request.parts, id, {}, &CheckedPart::id);
    return part != nullptr && before != checked_->request.parts.end() && before->id == id &&
           before->geometry == part->geometry && before->worldFromPart == context_.poses.poseOf(*part);
  };
  return isSameAs(pair.part) && isSameAs(pair.other);
}

}  // namespace nearfit::ui
