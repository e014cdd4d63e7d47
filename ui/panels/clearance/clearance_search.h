#pragma once

#include <QObject>
#include <QTimer>
#include <functional>
#include <optional>
#include <vector>

#include "core/report/clearance.h"
#include "core/session/session.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

namespace nearfit::ui {

/// Keeps the clearances of one part, or of the moving group, up to date while they are wanted. Searches in another
/// thread after a change, at most a few times a second; for what is in hand, also takes them from each tick that is
/// shown.
class ClearanceSearch : public QObject {
  Q_OBJECT

 public:
  /// Returns the moving part's worldFromPart now; anything if there is none.
  using PoseOfMoving = std::function<RigidTransform()>;

  /// @param session  Must outlive this.
  ClearanceSearch(Session& session, PoseOfMoving poseOfMoving, QObject* parent = nullptr);

  /// Starts or stops searching; at first nothing is wanted.
  void setWanted(bool isWanted);
  /// Chooses the part; std::nullopt: the moving part, whichever that is.
  void setSubject(std::optional<PartId> part);
  /// Returns the part whose clearances are kept, of a moving group the part that leads; std::nullopt if there is none.
  std::optional<PartId> subject() const;
  /// Returns the parts whose clearances are kept: those that move as one if a group is in hand and no part was chosen.
  std::vector<PartId> body() const;
  /// Returns the clearances found last.
  const std::vector<PartClearance>& clearances() const noexcept { return clearances_; }
  /// Returns the scene in which they were found, with its names and poses.
  const Scene& scene() const noexcept { return searched_; }
  /// Takes in a tick of the part in hand.
  void showSnapshot(const ServoSnapshot& snapshot);
  /// Searches again if the moving part has another pose than when this was called last.
  void followMoving();
  /// True if the last search was of the pose that the moving part has now.
  bool isOfPresentPose() const;

 signals:
  /// Emitted when clearances() changed.
  void changed();
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  void request();
  void search();
  bool isChosen() const { return chosen_ && session_.scene().find(*chosen_) != nullptr; }
  /// @param pose  Of the moving part in `scene`.
  void finish(const std::vector<PartId>& parts, const Scene& scene, const RigidTransform& pose,
              const std::vector<PartClearance>& found, const std::exception_ptr& error);

  Session& session_;
  const PoseOfMoving poseOfMoving_;
  BackgroundTask task_;
  QTimer timer_;
  std::optional<PartId> chosen_;
  Scene searched_;
  std::vector<PartClearance> clearances_;
  RigidTransform poseSearched_;  ///< Pose of the moving part in searched_.
  RigidTransform poseShown_;     ///< Pose of the moving part when it was followed last.
  bool isWanted_ = false, isDue_ = false;
  Subscription changes_;
};

}  // namespace nearfit::ui
