#pragma once

#include <QObject>
#include <QTimer>
#include <functional>
#include <optional>
#include <vector>

#include "core/report/clearance.h"
#include "core/session.h"
#include "ui/background_task.h"
#include "ui/dialogs/error_box.h"

namespace nearfit::ui {

/// Keeps the clearances of one part up to date while they are wanted: searched in another thread after a
/// change, no more often than a few times a second; and, for the moving part in hand, of each tick that is
/// shown.
class ClearanceSearch : public QObject {
  Q_OBJECT

 public:
  /// Where the moving part is now; anything when there is none.
  using PoseOfMoving = std::function<RigidTransform()>;

  /// @param session  Outlives this.
  ClearanceSearch(Session& session, PoseOfMoving poseOfMoving, QObject* parent = nullptr);

  /// Nothing is searched while it is not wanted.
  void setWanted(bool isWanted);
  /// Nothing: the moving part, whichever that is.
  void setSubject(std::optional<PartId> part);
  std::optional<PartId> subject() const;
  const std::vector<PartClearance>& clearances() const noexcept { return clearances_; }
  /// Names and poses that the clearances are of.
  const Scene& scene() const noexcept { return searched_; }
  /// The part in hand has moved.
  void showSnapshot(const ServoSnapshot& snapshot);

 signals:
  void changed();
  void failed(const nearfit::ui::Failure& failure);

 private:
  void request();
  void search();
  void finish(std::optional<PartId> part, const Scene& scene, const std::vector<PartClearance>& found,
              const std::exception_ptr& error);

  Session& session_;
  const PoseOfMoving poseOfMoving_;
  BackgroundTask task_;
  QTimer timer_;
  std::optional<PartId> chosen_;
  Scene searched_;
  std::vector<PartClearance> clearances_;
  RigidTransform poseShown_;  ///< Of the part in hand.
  bool isWanted_ = false, isDue_ = false;
};

}  // namespace nearfit::ui
