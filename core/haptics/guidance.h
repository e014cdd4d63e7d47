#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/haptics/device_limits.h"

namespace nearfit {

/// A weak pull of the hand toward a path.
struct GuidanceSettings {
  double stiffness = 60.0;  ///< [N/m]; > 0.
  double maxForce = 1.0;    ///< [N]; > 0.
  double reach = 0.02;      ///< Distance from the path at which the pull has faded [m]; > 0.
  bool operator==(const GuidanceSettings&) const = default;
};

/// Limits of these settings: a pull that the hand can leave.
constexpr double kMaxGuidanceStiffness = 1000.0, kMaxGuidanceForce = 5.0, kMaxGuidanceReach = 1.0;
/// Throws UsageError if a value is not finite, not above 0, or beyond its limit.
void checkGuidance(const GuidanceSettings& settings);

/// Share of the bound of a stable wall that the guidance may take, beside the coupling; and of the device's max force.
inline constexpr double kGuidanceShare = 0.1, kGuidanceForceShare = 0.25;

/// The guidance that is rendered on a device: within kGuidanceShare of stiffnessBound(), and kGuidanceForceShare of its
/// max force. Real-time safe.
/// @param device  Limits at the handle (limitsAtHandle()).
/// @param period  Measured [s].
GuidanceSettings boundedGuidance(const GuidanceSettings& wish, const DeviceLimits& device,
                                 double period) noexcept;

/// Pull at a distance from the path [N]: stiffness times the distance up to a peak, which is the max force or what the
/// stiffness gives at half the reach; the peak up to half the reach; from there it falls evenly to zero at the reach.
/// Real-time safe.
double guidanceForce(const GuidanceSettings& settings, double distance) noexcept;
/// Energy of the pull from the path to that distance [J]. Real-time safe.
double guidanceEnergy(const GuidanceSettings& settings, double distance) noexcept;

/// The way of a part's centre of mass, as straight segments in the world frame; immutable.
class GuidancePath {
 public:
  static constexpr std::size_t kMaxPoints = 1'000'000;

  /// @param points  At least 2, finite, of which each differs from the next; [m]. Throws UsageError if not, or if there are
  ///                more than kMaxPoints; as checkGuidance().
  GuidancePath(std::vector<glm::dvec3> points, const GuidanceSettings& settings);

  const GuidanceSettings& settings() const noexcept { return settings_; }
  std::size_t segments() const noexcept { return points_.size() - 1; }
  /// Nearest point of a segment; the first and the last one go on beyond the ends of the path, so that nothing pulls
  /// along it there. Real-time safe.
  glm::dvec3 nearestOn(std::size_t segment, const glm::dvec3& point) const noexcept;
  /// Unique in the process.
  std::uint64_t serial() const noexcept { return serial_; }

 private:
  std::vector<glm::dvec3> points_;
  GuidanceSettings settings_;
  std::uint64_t serial_;
};

/// A pull, and the energy that it can give back to the hand.
struct GuidancePull {
  glm::dvec3 force{0.0};  ///< World frame [N].
  double energy = 0.0;    ///< [J]
};

/// Follows a path from tick to tick, at bounded cost: it looks at segments near the last nearest one, and goes over to
/// others only while nothing pulls, so that the pull does not leap between two stretches of a path. Across the path the
/// pull is the derivative of its energy, so no closed way of the hand gains any, except where the path has a corner
/// between two equally near segments; the passivity controller accounts for that as for all that is rendered.
class GuidanceFollower {
 public:
  /// Segments looked at in a tick: to either side of the last one, and of the rest in turn.
  static constexpr std::size_t kWindow = 24, kScan = 48;

  /// Pull on a point that the hand carries. Real-time safe.
  /// @param settings  As rendered: boundedGuidance().
  GuidancePull follow(const GuidancePath& path, const GuidanceSettings& settings,
                      const glm::dvec3& point) noexcept;
  /// Forgets where it was.
  void reset() noexcept { *this = GuidanceFollower(); }

 private:
  std::uint64_t serial_ = 0;  ///< Of the path that it follows.
  std::size_t segment_ = 0;   ///< The nearest one in the last tick.
  std::size_t scanned_ = 0;   ///< Where the look at the rest goes on.
};

}  // namespace nearfit
