#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/haptics/guidance.h"
#include "core/math/rigid_transform.h"
#include "core/scene/scene.h"
#include "core/servo/motion_recording.h"

namespace nearfit {

/// A pose on a path.
struct PathPose {
  double time = 0.0;             ///< [s]
  RigidTransform worldFromLead;  ///< Unit quaternion.
};

/// Max number of poses on a path: some minutes at 1 kHz. More are thinned, or the motion is trimmed.
constexpr std::size_t kMaxPathPoses = 400'000;
/// Max magnitude of a time on a path [s], as in recordings.
constexpr double kMaxPathTime = 1e6;
/// Max turn between two poses [rad], 170 degrees: near half a turn, rounding would choose the way round.
constexpr double kMaxPathTurn = 2.967;

/// A motion of a part, or of parts that move as one: poses in order of time, and the way between them.
///
/// From one pose to the next the centre moves straight at constant speed, while the body turns about it the shorter way
/// at a constant rate about one axis: linear interpolation of the centre, slerp of the rotation. A *place* on a path is
/// the number of a pose, from 0, plus the share of the way to the next.
struct AssemblyPath {
  /// Names of the parts that move. The first leads: poses are those of its frame, and the others keep their places
  /// relative to it.
  std::vector<std::string> parts;
  glm::dvec3 centre{0.0};  ///< In the frame of the part that leads [m].
  std::vector<PathPose> poses;

  /// Place of the last pose.
  double end() const noexcept { return poses.empty() ? 0.0 : static_cast<double>(poses.size() - 1); }
};

/// Throws UsageError, naming `where`, unless there are 2 to kMaxPathPoses poses, with times that increase within
/// kMaxPathTime, valid poses (checkedPose) and turns within kMaxPathTurn, and parts that have different, valid names.
void checkPath(const AssemblyPath& path, const std::string& where);

/// Angle by which one pose is turned from another [rad]; at most pi.
double turnBetween(const RigidTransform& a, const RigidTransform& b) noexcept;

/// True if all numbers and names are the same, to the bit.
bool isSamePath(const AssemblyPath& a, const AssemblyPath& b) noexcept;

/// Pose between two others, at a share of the way (0 to 1); exactly `from` and `to` at its ends.
/// @param centre  In the frame that moves [m].
RigidTransform poseBetween(const RigidTransform& from, const RigidTransform& to, const glm::dvec3& centre,
                           double share) noexcept;
/// worldFromLead at a place, clamped to the path, which has a pose.
RigidTransform poseAt(const AssemblyPath& path, double place) noexcept;
/// Time at a place, clamped to the path [s].
double timeAt(const AssemblyPath& path, double place) noexcept;
/// Place at a time [s], clamped to the path. O(log n).
double placeAt(const AssemblyPath& path, double time) noexcept;

/// Way of a point of what moves and of its rotation, as a polyline in the world: where they are at the poses, and between them
/// as often as the turn takes to be straight to within 1/3000 of the point's distance from the centre. Poses that are the
/// same follow each other once; a path on which nothing moves gives one.
/// @param point  In the frame of the part that leads [m].
std::vector<GuidancePose> wayOf(const AssemblyPath& path, const glm::dvec3& point);

/// Upper bound on the distance between where two poses have a point of a body [m].
/// @param radius  Of the body about the centre [m].
double displacementBound(const RigidTransform& a, const RigidTransform& b, const glm::dvec3& centre,
                         double radius) noexcept;

/// The part of a path from one time to another [s]; its ends are poses, interpolated if need be. Throws UsageError if
/// less than two poses would be left.
AssemblyPath trimmed(const AssemblyPath& path, double from, double to);

/// Parts and centre of a path of what the scene has in hand, without poses. The parts are its moving part, or those of its
/// moving group that are visible; the centre is that of their box. Throws UsageError if nothing is in hand.
AssemblyPath pathFrame(const Scene& scene);

/// The path of what the hand moved in a recording: worldFromPart of each row (its proxy). Of rows at one time the last
/// counts.
/// @param scene  Parts and centre are those of pathFrame().
/// @param from, to  As for trimmed().
/// Throws UsageError if nothing is in hand, or as checkPath().
AssemblyPath pathOfMotion(std::span<const MotionRow> rows, const Scene& scene, double from = 0.0,
                          double to = std::numeric_limits<double>::infinity());

}  // namespace nearfit
