#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "device/simulated/simulated_device.h"

namespace nearfit {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Shares of the sweep at which slide, wobble and retreat begin; the approach begins at 0.
constexpr double kSlideBegins = 0.25, kWobbleBegins = 0.5, kRetreatBegins = 0.75;

/// More would not fit in memory, and means a wrong unit.
constexpr double kMaxPoses = 1e8;

/// Rises from 0 to 1 with zero velocity and acceleration at both ends.
double ease(double x) {
  return x <= 0.0 ? 0.0 : x >= 1.0 ? 1.0 : x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

/// Returns the eased fraction of `x` between two shares of the sweep.
double easeBetween(double x, double begin, double end) {
  return ease((x - begin) / (end - begin));
}

struct Frame {
  glm::dvec3 along, across, aside;
};

Frame frameAlong(const glm::dvec3& direction) {
  const glm::dvec3 along = glm::normalize(direction);
  const glm::dvec3 seed = std::abs(along.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 across = glm::normalize(glm::cross(seed, along));
  return {along, across, glm::cross(along, across)};
}

struct Sweep {
  double reach, wobbleAngle, slideRadius;
};

RigidTransform poseAt(const RigidTransform& rest, const Frame& frame, const Sweep& sweep, double x) {
  const double advance = easeBetween(x, 0.0, kSlideBegins) - easeBetween(x, kRetreatBegins, 1.0);
  // The circle starts and ends at the same rim point, so that the slide leaves no offset.
  const double turn = 2.0 * kPi * easeBetween(x, kSlideBegins, kWobbleBegins);
  const glm::dvec3 slide =
      sweep.slideRadius * ((std::cos(turn) - 1.0) * frame.across + std::sin(turn) * frame.aside);
  const double phase = 2.0 * kPi * easeBetween(x, kWobbleBegins, kRetreatBegins);
  const glm::dvec3 tilt =
      sweep.wobbleAngle * (std::sin(phase) * frame.across + std::sin(2.0 * phase) * frame.along);
  const double angle = glm::length(tilt);
  const glm::dquat wobble =
      angle > 0.0 ? glm::angleAxis(angle, tilt / angle) : glm::dquat(1.0, 0.0, 0.0, 0.0);
  return RigidTransform{wobble * rest.rotation,
                        rest.translation + sweep.reach * advance * frame.along + slide}
      .normalized();
}

}  // namespace

std::vector<RigidTransform> scriptedHandPath(const RigidTransform& worldFromPart, const glm::dvec3& approach,
                                             double reach, double seconds, double period, double wobbleAngle,
                                             double slideShare) {
  const double directionLength = glm::length(approach);
  if (!worldFromPart.isFinite() || !std::isfinite(directionLength) || !(directionLength > 0.0)) {
    throw UsageError("scripted hand", "its pose or direction is not finite, or the direction is zero",
                     "give a pose and a direction");
  }
  if (!std::isfinite(reach) || !(reach > 0.0) || !std::isfinite(seconds) || !(seconds > 0.0) ||
      !std::isfinite(wobbleAngle) || !std::isfinite(slideShare) || slideShare < 0.0 ||
      !std::isfinite(period) || !(period > 0.0) || seconds / period > kMaxPoses) {
    throw UsageError("scripted hand", "reach, duration, period or slide is not a valid positive number",
                     "give metres and seconds above zero");
  }
  const RigidTransform rest = worldFromPart.normalized();
  const Frame frame = frameAlong(approach);
  const Sweep sweep{reach, wobbleAngle, slideShare * reach};
  const auto steps = static_cast<std::size_t>(std::max(1.0, std::round(seconds / period)));
  std::vector<RigidTransform> path;
  path.reserve(steps + 1);
  for (std::size_t i = 0; i <= steps; ++i) {
    path.push_back(poseAt(rest, frame, sweep, static_cast<double>(i) / static_cast<double>(steps)));
  }
  return path;
}

}  // namespace nearfit
