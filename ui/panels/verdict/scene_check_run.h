#pragma once

#include <QObject>
#include <QTimer>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/session/session.h"
#include "core/verdict/finding_states.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

namespace nearfit::ui {

class ShownPoses;

/// A check with the scene that it was made of, and what it is compared with. Immutable once made.
struct CheckedScene {
  Scene scene;                ///< As it was checked; has all parts of the findings.
  SceneCheckRequest request;  ///< Parts where they were shown.
  SceneCheck check;
  std::vector<ComparedFinding> compared;  ///< With what the scene kept of the check before.
};

/// Checks the scene in threads of low priority when asked to, keeps the findings with the scene, and watches
/// whether the scene is still as it was checked. Parts that are dragged, played or in hand are checked where
/// they are shown.
class SceneCheckRun : public QObject {
  Q_OBJECT

 public:
  /// Objects that it checks; all outlive this.
  struct Context {
    Session& session;
    const ShownPoses& poses;
  };
  explicit SceneCheckRun(const Context& context, QObject* parent = nullptr);

  /// Checks the scene as it is now; no-op while it is being checked.
  /// @param threshold  As in SceneCheckRequest [m].
  void start(double threshold);
  /// Gives up the check that is running; the last result stays.
  void cancel();

  bool isRunning() const noexcept { return task_.isRunning(); }
  /// True if the user has cancelled, and nothing was checked since.
  bool isCancelled() const noexcept { return isCancelled_; }
  /// The last result; null if there is none of this scene.
  const std::shared_ptr<const CheckedScene>& checked() const noexcept { return checked_; }
  /// True if parts or rules have changed since the last result, or have moved some tenths of a second ago.
  bool isStale() const noexcept { return isStale_; }
  /// True if both parts are where they were when they were checked, and look as they did. False without a result.
  bool isAsChecked(const PartPair& pair) const;

 signals:
  /// Emitted when checked() is another.
  void changed();
  void staleChanged();
  /// Emitted when isRunning() or isCancelled() changed.
  void workChanged();
  /// Emitted with the fraction done.
  void progressed(double fraction);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  SceneCheckRequest present(double threshold) const;
  void finish(const std::shared_ptr<CheckedScene>& checked, const std::exception_ptr& error);
  /// Puts the findings into the session.
  void keep();
  void followSession();
  void compareWithScene();

  const Context context_;
  BackgroundTask task_;
  QTimer late_;  ///< Gathers motions, which may come with each picture.
  std::shared_ptr<const CheckedScene> checked_;
  std::uint64_t sceneSerial_ = 0;  ///< Serial of the scene that is or was checked.
  bool isStale_ = false, isCancelled_ = false;
  Subscription changes_;
};

}  // namespace nearfit::ui
