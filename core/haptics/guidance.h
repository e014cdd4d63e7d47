#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/haptics/device_limits.h"

namespace nearfit {

/// A weak pull of the hand toward a path, in place and turn.
struct GuidanceSettings {
  double stiffness = 60.0;  ///< [N/m]; > 0.
  double maxForce = 1.0;    ///< [N]; > 0.
  double reach = 0.02;      ///< Distance from the path at which the pull has faded [m]; > 0.
  /// Angle from the path's orientation at which it has faded [rad]; 0: turns are not guided, and do not count.
  double turnReach = 1.0;
  bool operator==(const GuidanceSettings&) const = default;
};

/// Limits of these settings: a pull that the hand can leave. At half a turn from the path nothing tells which way leads
/// back: the pull has to fade before (at 2 sqrt(2) as angles are measured, see GuidancePath).
constexpr double kMaxGuidanceStiffness = 1000.0, kMaxGuidanceForce = 5.0, kMaxGuidanceReach = 1.0,
                 kMaxGuidanceTurn = 2.5;
/// Throws UsageError if a value is not finite, not above 0 (turnReach: below 0), or beyond its limit.
void checkGuidance(const GuidanceSettings& settings);

/// Distance that a turn by one radian counts for [m/rad]: the reach over turnReach; 0 if turns are not guided.
/// Real-time safe.
double guidanceArm(const GuidanceSettings& settings) noexcept;

/// Share of the bound of a stable wall that the guidance may take, beside the coupling; and of the device's max force.
inline constexpr double kGuidanceShare = 0.1, kGuidanceForceShare = 0.25;

/// The guidance that is rendered on a device: within kGuidanceShare of stiffnessBound(), and kGuidanceForceShare of its
/// max force, for torques as for forces. Where that makes turns too weak to fade within kMaxGuidanceTurn, as on devices
/// without torque, they are not guided. Real-time safe.
/// @param device  Limits at the handle (limitsAtHandle()).
/// @param period  Measured [s].
GuidanceSettings boundedGuidance(const GuidanceSettings& wish, const DeviceLimits& device,
                                 double period) noexcept;

/// Pull at a distance from the path, as GuidancePath measures it [N]: stiffness times the distance up to a peak, which is the max force or what the
/// stiffness gives at half the reach; the peak up to half the reach; from there it falls evenly to zero at the reach.
/// Real-time safe.
double guidanceForce(const GuidanceSettings& settings, double distance) noexcept;
/// Energy of the pull from the path to that distance [J]. Real-time safe.
double guidanceEnergy(const GuidanceSettings& settings, double distance) noexcept;

/// Where the hand is to be on a path, and where it is: the part's centre of mass, and its rotation. World frame.
struct GuidancePose {
  glm::dvec3 place{0.0};            ///< [m]
  glm::dquat rotation{1, 0, 0, 0};  ///< worldFromPart; of unit length.
};

/// How far a pose is from the nearest one of a stretch of a path, and the way there.
struct GuidanceOffset {
  double distance = 0.0;  ///< In place and turn [m].
  glm::dvec3 shift{0.0};  ///< To it [m].
  glm::dvec3 turn{0.0};   ///< To it, in the world frame, as weighted for the torque [m^2/rad].
};

/// The way of a part's centre of mass and its rotation, as straight segments in the world frame; immutable.
///
/// Place and turn are measured together: poses are points (place, 2 arm q), with q the unit quaternion, the segments are
/// straight between these, and distance is Euclidean. So a turn by an angle counts as arm * 4 sin(angle / 4), about arm times
/// the angle; the nearest pose of a segment has a closed form; and a force that is a function of the distance is the
/// derivative of an energy, in place and turn, and never draws along the path.
class GuidancePath {
 public:
  static constexpr std::size_t kMaxPoints = 1'000'000;

  /// @param poses  At least 2, finite, of which each differs from the next. Throws UsageError if not, or if there are more
  ///               than kMaxPoints; as checkGuidance(). A segment that turns far is divided.
  GuidancePath(std::vector<GuidancePose> poses, const GuidanceSettings& settings);

  const GuidanceSettings& settings() const noexcept { return settings_; }
  std::size_t segments() const noexcept { return poses_.size() - 1; }
  /// Offset to the nearest pose of a segment; the first and the last one go on straight beyond the ends of the path, so that
  /// nothing pulls along it there. Real-time safe.
  /// @param arm  guidanceArm() of what is rendered [m/rad].
  GuidanceOffset offsetTo(std::size_t segment, const GuidancePose& from, double arm) const noexcept;
  /// Unique in the process.
  std::uint64_t serial() const noexcept { return serial_; }

 private:
  std::vector<GuidancePose> poses_;
  GuidanceSettings settings_;
  std::uint64_t serial_;
};

/// A pull, and the energy that it can give back to the hand.
struct GuidancePull {
  glm::dvec3 force{0.0};  ///< World frame [N].
  glm::dvec3 torque{
      0.0};  ///< About the part's centre of mass, world frame [N m]; at most arm times the max force.
  double energy = 0.0;  ///< [J]
};

/// Follows a path from tick to tick, at bounded cost: it looks at segments near the last nearest one, and goes over to
/// others only while nothing pulls, so that the pull does not leap between two stretches of a path. The pull is the derivative of its energy, so no closed way of the hand gains any, except where the path has a corner
/// between two equally near segments; the passivity controller accounts for that as for all that is rendered.
class GuidanceFollower {
 public:
  /// Segments looked at in a tick: to either side of the last one, and of the rest in turn.
  static constexpr std::size_t kWindow = 24, kScan = 48;

  /// Pull on what the hand carries. Real-time safe.
  /// @param settings  As rendered: boundedGuidance().
  GuidancePull follow(const GuidancePath& path, const GuidanceSettings& settings,
                      const GuidancePose& hand) noexcept;
  /// Forgets where it was.
  void reset() noexcept { *this = GuidanceFollower(); }

 private:
  std::uint64_t serial_ = 0;  ///< Of the path that it follows.
  std::size_t segment_ = 0;   ///< The nearest one in the last tick.
  std::size_t scanned_ = 0;   ///< Where the look at the rest goes on.
};

}  // namespace nearfit
