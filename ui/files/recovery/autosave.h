#pragma once

#include <QObject>
#include <QTimer>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "core/recovery/recovery_folder.h"
#include "core/session/session.h"
#include "ui/widgets/background_task.h"

namespace nearfit::ui {

/// Keeps unsaved work in this process's recovery journal: writes it in another thread shortly after a change,
/// never without one, and removes it when there is nothing to lose.
class Autosave : public QObject {
  Q_OBJECT

 public:
  /// Delay after a change, and interval while a part is in hand [ms].
  static constexpr int kDelay = 1000, kMotionInterval = 2000;
  /// The part in hand and its worldFromPart; empty if there is none.
  using PoseInHand = std::optional<std::pair<PartId, RigidTransform>>;

  /// @param session     Must outlive this.
  /// @param poseInHand  Returns the part in hand and its pose; called on this object's thread.
  Autosave(Session& session, std::shared_ptr<RecoveryFolder> folder, std::function<PoseInHand()> poseInHand,
           QObject* parent = nullptr);

  /// Keeps the pose of the part in hand soon, without an undo step.
  void noteMotion();
  /// Writes without delay; written() or failed() tells the outcome.
  void writeNow();
  bool isWriting() const noexcept { return task_ && task_->isRunning(); }
  /// For a clean exit: writes nothing any more and removes the journal.
  void finish();

 signals:
  /// Emitted when the journal holds the scene as it was when writing began.
  void written();
  /// Emitted when the journal could not be written; once, until it can be again.
  void failed(const QString& cause);

 private:
  /// Tells one content of the journal from another.
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
  std::optional<Content> content_;  ///< Content of the journal; empty if there is none.
  bool hasFailed_ = false, isDue_ = false;
  Subscription changes_;
};

}  // namespace nearfit::ui
