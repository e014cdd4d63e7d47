#pragma once

#include <QObject>
#include <QTimer>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "core/recovery/recovery_folder.h"
#include "core/session.h"
#include "ui/background_task.h"

namespace nearfit::ui {

/// Keeps what is not saved in this process's recovery journal: written in another thread shortly after a
/// change, never when nothing has changed, removed when there is nothing to lose.
class Autosave : public QObject {
  Q_OBJECT

 public:
  /// How long after a change, and how often while a part is in hand [ms].
  static constexpr int kDelay = 1000, kMotionInterval = 2000;
  /// The part in hand and where it is; empty when none is.
  using PoseInHand = std::optional<std::pair<PartId, RigidTransform>>;

  /// @param session  Outlives this.
  Autosave(Session& session, std::shared_ptr<RecoveryFolder> folder, std::function<PoseInHand()> poseInHand,
           QObject* parent = nullptr);

  /// The part in hand may have moved: its pose is kept too, without a step of undo.
  void noteMotion();
  /// Without a delay; `written` or `failed` tells of it.
  void writeNow();
  bool isWriting() const noexcept { return task_ && task_->isRunning(); }
  /// A clean exit: nothing is written any more, and the journal is removed.
  void finish();

 signals:
  /// The journal holds the scene as it was when writing began.
  void written();
  /// It could not be written; told once, until it can be again.
  void failed(const QString& cause);

 private:
  /// What tells one content of the journal from another.
  struct Content {
    std::uint64_t serial = 0;
    std::filesystem::path file;
    PoseInHand pose;
  };
  static bool isSame(const Content& a, const Content& b);
  void noteChange();
  void write();
  void run(BackgroundTask::Job job, std::optional<Content> content);

  Session& session_;
  std::shared_ptr<RecoveryFolder> folder_;
  std::function<PoseInHand()> poseInHand_;
  QTimer changed_, moved_;
  std::unique_ptr<BackgroundTask> task_;
  std::optional<Content> content_;  ///< Of the journal, when there is one.
  bool hasFailed_ = false, isDue_ = false;
};

}  // namespace nearfit::ui
