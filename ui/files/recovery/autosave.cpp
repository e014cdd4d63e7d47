#include "ui/files/recovery/autosave.h"

#include "core/base/error.h"
#include "core/scene/moving_body.h"

namespace nearfit::ui {
namespace {

QString causeOf(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const Error& e) {
    return QString::fromStdString(e.where() + ": " + e.problem());
  } catch (const std::exception& e) {
    return QString::fromLocal8Bit(e.what());
  }
}

}  // namespace

Autosave::Autosave(Session& session, std::shared_ptr<RecoveryFolder> folder,
                   std::function<PoseInHand()> poseInHand, QObject* parent)
    : QObject(parent),
      session_(session),
      folder_(std::move(folder)),
      poseInHand_(std::move(poseInHand)),
      task_(std::make_unique<BackgroundTask>()) {
  for (QTimer* timer : {&changed_, &moved_}) {
    timer->setSingleShot(true);
    connect(timer, &QTimer::timeout, this, &Autosave::write);
  }
  changed_.setInterval(kDelay);
  moved_.setInterval(kMotionInterval);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { noteChange(); });
}

void Autosave::noteChange() {
  // A change does not restart the delay, so that work without a pause is kept too.
  if (task_ && !changed_.isActive()) changed_.start();
}

void Autosave::noteMotion() {
  if (task_ && !moved_.isActive()) moved_.start();
}

void Autosave::writeNow() {
  content_.reset();
  write();
}

bool Autosave::isSame(const Content& a, const Content& b) {
  if (a.serial != b.serial || a.file != b.file || a.pose.has_value() != b.pose.has_value()) return false;
  return !a.pose || (a.pose->first == b.pose->first && a.pose->second == b.pose->second);
}

void Autosave::write() {
  if (!task_) return;
  if (task_->isRunning()) {
    isDue_ = true;
    return;
  }
  Content content{session_.stateSerial(), session_.file(), poseInHand_()};
  const Part* held = content.pose ? session_.scene().find(content.pose->first) : nullptr;
  if (held == nullptr || held->worldFromPart == content.pose->second) content.pose.reset();
  const std::size_t changes = session_.changesSinceSave() + (content.pose ? 1 : 0);
  if (changes == 0) {
    if (content_) run([folder = folder_](const ProgressCallback&) { folder->clear(); }, std::nullopt);
    return;
  }
  if (content_ && isSame(*content_, content)) return;
  const auto job = [folder = folder_, scene = session_.scene(), content, changes](const ProgressCallback&) {
    Scene kept = scene;
    // The parts of a group in hand move along.
    if (content.pose && kept.movingPart() == content.pose->first) {
      for (const auto& [id, pose] : movedPoses(kept, content.pose->second)) {
        Part part = kept.get(id);
        part.worldFromPart = pose;
        kept.replace(std::move(part));
      }
    }
    folder->write(kept, {content.file, changes, kept.parts().size()});
  };
  run(job, content);
}

void Autosave::run(BackgroundTask::Job job, std::optional<Content> content) {
  task_->run(std::move(job), [this, content = std::move(content)](const std::exception_ptr& error) {
    if (!error) {
      content_ = content;
      hasFailed_ = false;
      if (content) emit written();
    } else if (!std::exchange(hasFailed_, true)) {
      emit failed(causeOf(error));
    }
    if (std::exchange(isDue_, false)) changed_.start();
  });
}

void Autosave::finish() {
  changed_.stop();
  moved_.stop();
  task_.reset();
  folder_->clear();
}

}  // namespace nearfit::ui
