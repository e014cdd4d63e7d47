#pragma once

#include <QObject>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/servo/servo_snapshot.h"
#include "core/session/session.h"
#include "ui/model/servo_status.h"

namespace nearfit::ui {

class ShownPoses;

/// Who holds the moving part, and where: the servo as last reported. Panels, tools and the view follow it.
///
/// All that shows what is felt shows one snapshot: the view takes each (snapshotShown), numbers beside it change when
/// the view has drawn it (snapshotDrawn). When the part is put down, all go on showing the last one, as past
/// (snapshotKept), until the scene changes (snapshotCleared).
class HandState : public QObject {
  Q_OBJECT

 public:
  /// @param session  Outlives this.
  /// @param poses    Learns where the servo has the part in hand; outlives this.
  HandState(Session& session, ShownPoses& poses, QObject* parent = nullptr);

  const ServoStatus& status() const noexcept { return status_; }
  /// True while the servo runs with that hand.
  bool isHeldBy(Hand hand) const noexcept { return status_.isRunning && status_.hand == hand; }
  /// Returns the part in hand, of a group the part that leads; nullopt unless the servo runs.
  std::optional<PartId> part() const;
  /// True if the servo moves the part, by itself or in a group.
  bool holds(std::optional<PartId> part) const;
  /// True if what is in hand is a group, and the servo runs.
  bool holdsGroup() const;
  /// Returns where the servo has the part in hand (worldFromPart); the identity without one.
  RigidTransform partPose() const;
  /// Returns where the manual hand wants the part (worldFromPart), which may lag behind; for other hands
  /// partPose().
  RigidTransform handPose() const { return isHeldBy(Hand::Manual) ? handPose_ : partPose(); }
  /// Sets where the manual hand wants the part (worldFromPart).
  void setHandPose(const RigidTransform& worldFromPart) { handPose_ = worldFromPart; }

 public slots:
  /// Takes in the servo's state.
  void showStatus(const nearfit::ui::ServoStatus& status);
  /// Takes in a tick of the part in hand.
  void showSnapshot(const nearfit::ServoSnapshot& snapshot);
  /// Tells that the view has drawn a snapshot; ignored unless the servo runs, as the view also draws recordings.
  void noteDrawn(const nearfit::ServoSnapshot& snapshot);
  /// Ends the show of the snapshot kept since the part was put down; no-op without one.
  void clearKept();

 signals:
  /// Emitted with each state, several times a second while the servo runs.
  void statusChanged(const nearfit::ui::ServoStatus& status);
  /// Emitted after statusChanged() when the servo has started or stopped, opens a device or has another hand.
  void changed();
  /// Emitted with each tick that is shown.
  void snapshotShown(const nearfit::ServoSnapshot& snapshot);
  /// Emitted with each tick that the view has drawn.
  void snapshotDrawn(const nearfit::ServoSnapshot& snapshot);
  /// Emitted, before changed(), when the part was put down: the last tick, which is past.
  void snapshotKept(const nearfit::ServoSnapshot& snapshot);
  /// Emitted, before changed(), when the last snapshot no longer holds, even as past.
  void snapshotCleared();

 private:
  void keepLast();
  void clearLast();
  /// Ends the show of a past snapshot once it is not how things are.
  void followSession();

  Session& session_;
  ShownPoses& poses_;
  ServoStatus status_;
  RigidTransform handPose_;              ///< Of the manual hand.
  std::unique_ptr<ServoSnapshot> last_;  ///< The snapshot on show; null if there is none.
  std::uint64_t sceneSerial_ = 0;        ///< Serial of its scene.
  /// State of the session when the part was put down, while last_ is past.
  std::optional<std::uint64_t> keptState_;
  Subscription changes_;
};

}  // namespace nearfit::ui
