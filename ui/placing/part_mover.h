#pragma once

#include <QObject>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "ui/placing/solid_runner.h"

namespace nearfit::ui {

/// Parts under way: where a drag has them, until it ends in one pose for each, or is given up. Nothing of it
/// is in the session meanwhile, so that giving up restores exactly.
///
/// Solid parts stop at contact, and so may come later than the pointer: an end waits until they have settled
/// where they were wanted last.
class PartMover : public QObject {
  Q_OBJECT

 public:
  explicit PartMover(QObject* parent = nullptr);

  /// @param scene  Where all parts are now.   @param parts  Of it; not empty; with geometries.
  void begin(const Scene& scene, const std::vector<PartId>& parts, bool isSolid);
  bool isUnderWay() const noexcept { return !parts_.empty(); }
  /// Whether they only come to rest where they were wanted last.
  bool isEnding() const noexcept { return isEnding_; }

  /// What stood at a point p of the world at the start is wanted at motion(p).
  void moveTo(const RigidTransform& motion);
  /// Where they are then is final: says so by `ended`, at once or when they have settled.
  void end();
  /// As end(), where they are now.
  void endHere();
  /// Says nothing.
  void giveUp();

  const std::vector<PartId>& parts() const noexcept { return parts_; }
  /// worldFromPart of each when it began.
  const std::map<PartId, RigidTransform>& start() const noexcept { return start_; }
  /// worldFromPart of each.
  const std::map<PartId, RigidTransform>& poses() const noexcept { return poses_; }
  /// From the start to where they are.
  const RigidTransform& motion() const noexcept { return motion_; }
  /// Whether they are where they were wanted last.
  bool hasArrived() const noexcept { return hasArrived_; }
  /// What holds them back.
  const std::vector<PartId>& touching() const noexcept { return touching_; }
  /// Whether what they may touch is still being prepared: they do not move before.
  bool isPreparing() const noexcept { return isSolid_ && !hasReached_; }

 signals:
  /// They are elsewhere.
  void moved();
  /// The poses are final; giveUp() has yet to be called.
  void ended();
  /// It could not be found out what is in the way; they are given up.
  void failed(const std::exception_ptr& error);

 private:
  void showReached(const SolidReached& reached);

  SolidRunner runner_;
  std::vector<PartId> parts_;
  std::map<PartId, RigidTransform> start_, poses_;
  RigidTransform motion_;
  std::vector<PartId> touching_;
  std::uint64_t wanted_ = 0;   ///< Of the runner, what was wanted last.
  std::uint64_t settled_ = 0;  ///< And what they have settled at.
  bool isSolid_ = false, isEnding_ = false, hasReached_ = false, hasArrived_ = false;
};

}  // namespace nearfit::ui
