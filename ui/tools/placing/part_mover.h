#pragma once

#include <QObject>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "core/placing/jointed_motion.h"
#include "core/scene/scene.h"
#include "ui/tools/placing/solid_runner.h"

namespace nearfit::ui {

/// Moves parts by a drag until end() makes their poses final or giveUp() discards them. The session does not
/// change meanwhile, so that giving up restores the exact state.
///
/// Parts stay on their joints. Solid parts stop at contact, so they may lag behind the pointer: end() waits until
/// they have settled for the last moveTo().
class PartMover : public QObject {
  Q_OBJECT

 public:
  explicit PartMover(QObject* parent = nullptr);

  /// Starts a move and gives up any other.
  /// @param scene    All parts where they are now.
  /// @param parts    Parts of `scene` with geometry; not empty.
  /// @param isSolid  They stop at contact.
  void begin(const Scene& scene, const std::vector<PartId>& parts, bool isSolid);
  bool isUnderWay() const noexcept { return !parts_.empty(); }
  /// True after end() while solid parts still settle.
  bool isEnding() const noexcept { return isEnding_; }

  /// Sets where the parts are wanted: what was at a world point p at the start is wanted at motion(p), or as near as
  /// their joints allow.
  void moveTo(const RigidTransform& wanted);
  /// Makes the poses final: emits ended() at once, or when solid parts have settled. moveTo()
  /// is ignored from then on.
  void end();
  /// Makes the present poses final: emits ended() at once.
  void endHere();
  /// Discards the move without a signal.
  void giveUp();

  const std::vector<PartId>& parts() const noexcept { return parts_; }
  /// worldFromPart of each part at the start.
  const std::map<PartId, RigidTransform>& start() const noexcept { return start_; }
  /// worldFromPart of each part now.
  const std::map<PartId, RigidTransform>& poses() const noexcept { return poses_; }
  /// World motion from the start to now.
  const RigidTransform& motion() const noexcept { return motion_; }
  /// True if the parts are exactly where they were last wanted.
  bool hasArrived() const noexcept { return hasArrived_; }
  /// Parts that hold them back.
  const std::vector<PartId>& touching() const noexcept { return touching_; }
  /// True if joints keep the parts from where they were last wanted.
  bool isHeldByJoints() const noexcept { return isHeldByJoints_; }
  /// True while solid parts wait for contact to be prepared; they do not move until then.
  bool isPreparing() const noexcept { return isSolid_ && !hasReached_; }

 signals:
  /// Emitted when poses, motion or touched parts have changed.
  void moved();
  /// Emitted when the poses are final. The receiver reads them and calls giveUp().
  void ended();
  /// Emitted when contact could not be computed; the move has been given up.
  void failed(const std::exception_ptr& error);

 private:
  void showReached(const SolidReached& reached);

  SolidRunner runner_;
  JointedMotion joints_;
  std::vector<PartId> parts_;
  std::map<PartId, RigidTransform> start_, poses_;
  RigidTransform motion_;
  std::vector<PartId> touching_;
  std::uint64_t wanted_ = 0;   ///< Last want() of the runner.
  std::uint64_t settled_ = 0;  ///< The want() for which they have settled.
  bool isSolid_ = false, isEnding_ = false, hasReached_ = false, hasArrived_ = false;
  bool isHeldByJoints_ = false;
};

}  // namespace nearfit::ui
