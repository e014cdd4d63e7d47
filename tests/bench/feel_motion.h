#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench {

/// How a hand presses a part into contact and moves it along: each amplitude belongs to a slow sine, all of
/// different frequencies, so that the motion is smooth and does not repeat.
struct PressingMotion {
  RigidTransform start;               ///< worldFromPart; the part is free there.
  glm::dvec3 centreInPart{0.0};       ///< What turns are about.
  glm::dvec3 axis{0.0, 0.0, 1.0};     ///< Unit; slides go along it, turns about it.
  glm::dvec3 towards{1.0, 0.0, 0.0};  ///< Unit, square to the axis: where the hand presses.
  double press = 0.0;                 ///< How far [m]: to contact and beyond.
  double swing = 0.0;                 ///< Of the pressing direction about the axis, either way [rad].
  double slide = 0.0;                 ///< [m]
  double turn = 0.0, tilt = 0.0;      ///< Tilts are about lines square to the axis [rad].
  double lead = 0.0;                  ///< Way along the axis with each radian of the turn [m/rad].
};

/// Time until a hand presses in full [s]: from there on it is in contact.
inline constexpr double kApproachTime = 1.0;

/// Where the hand is so long after it began [s].
RigidTransform handAt(const PressingMotion& motion, double time);

/// Of a displacement whose direction jumps from one nearest point to the next: the hand's own inertia [s].
inline constexpr double kSmoothing = 0.05;

/// Ticks of a path that presses a part into the scene nearly all the time.
struct SeekingPathOptions {
  std::size_t ticks = 5000;
  double speed = 0.1;   ///< Along the path that the hand presses down from [m/s].
  double press = 0.01;  ///< Beyond where the part would touch [m].
  std::uint64_t seed = 1;
};

/// The hand follows a path of makePath() that stays close to the scene, displaced to where the part would
/// touch and beyond, at 1 kHz. The displacement is smoothed over kSmoothing, as its direction changes with
/// each nearest point. sceneFromHand; begins where the part is free, and the hand lets go first.
std::vector<RigidTransform> seekingPath(const PreparedScene& scene, const SeekingPathOptions& options);

}  // namespace nearfit::bench
