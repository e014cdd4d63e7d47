#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace nearfit::falcon {

/// The mechanics of the Novint Falcon: three legs about z, each a thigh on a motor and a shin of two parallel
/// bars, which keep the grip from turning (a translational platform after Tsai and Stamper). x to the right,
/// y up, z towards the user; the origin is in the middle of the thighs' joints. [m], [rad]. Real-time safe.
///
/// In the frame of a leg, u out from the axis, v across, w along z, the grip at (u, v, w): with q = (u - r +
/// c, w) and thigh end k = a (cos t, sin t),
///
///     |q - k| = d + e + sqrt(b^2 - (v - s + f)^2)
///
/// Source: Stamper, "A three degree of freedom parallel manipulator with only translational degrees of
/// freedom", PhD 97-4, Maryland 1997, for the geometry; libnifalcon for its measures. The solutions are ours.
namespace geometry {
constexpr double kThigh = 0.060;              ///< a
constexpr double kShin = 0.1025;              ///< b
constexpr double kGripOut = 0.014;            ///< c: from the shin's end to the grip's middle, outwards.
constexpr double kShinJoints = 0.0225;        ///< d + e: from thigh to bars, and from bars to grip.
constexpr double kGripAcross = -0.025;        ///< f: as kGripOut, across.
constexpr double kBaseOut = 0.037233758;      ///< r: from the axis to the thigh's joint, outwards.
constexpr double kBaseAcross = -0.027330909;  ///< s: across.
constexpr double kFirstLeg = 105.0;           ///< Where legs stand about z [degrees]; 120 less for each next.
constexpr double kAngleAtIndex = 35.0;        ///< Of thighs where encoders count 0 [degrees].
constexpr double kSlots = 320;                ///< Of an encoder's wheel; four counts each.
constexpr double kGearRatio = 0.110 / 0.01425;  ///< Diameter of the thigh's drum over the motor's.
}  // namespace geometry

/// Thighs are between these all over the workspace of four inches each way, with room: farther out an encoder
/// has not found its index [rad].
constexpr double kLeastAngle = -1.0, kMostAngle = 2.1;

/// A motor's own unit for each newton metre on its thigh, turning it back (libnifalcon); and the most that one is told,
/// which no source gives: well above what the nine newtons that its maker promises need near the middle.
constexpr double kUnitsPerNewtonMetre = 10'000.0;
constexpr int kMostUnits = 4096;

/// In the middle of the workspace.
constexpr glm::dvec3 kCentre{0.0, 0.0, 0.125};

glm::dvec3 anglesOf(const std::array<std::int16_t, 3>& encoders) noexcept;
bool isInRange(const glm::dvec3& angles) noexcept;

/// The thighs' angles for a place of the grip, knees outwards, in closed form; nothing beyond the legs'
/// reach.
std::optional<glm::dvec3> inverse(const glm::dvec3& position) noexcept;

/// The place of the grip for the thighs' angles, before the knees, by Newton's method.
///
/// @param start  Near it: the place a moment ago. Where that leads nowhere, the search begins anew from
///               kCentre.
/// @return Nothing when it does not converge within kMostIterations, or to a pose that the device cannot have
/// (knees inwards, grip behind them). What is returned fulfils the legs' equations to rounding and is not
/// singular: that is checked, not taken from the iteration.
std::optional<glm::dvec3> forward(const glm::dvec3& angles, const glm::dvec3& start) noexcept;
constexpr int kMostIterations = 30;

/// What the grip moves for each radian [m/rad]: a column a thigh. Not finite where it is singular.
/// @param angles  Those of `position`.
glm::dmat3 jacobian(const glm::dvec3& position, const glm::dvec3& angles) noexcept;

/// What to tell the motors so that the grip pushes with `force` [N]: J^T f, by virtual work. Where a motor
/// cannot, all push less, so that the direction stays.
std::array<std::int16_t, 3> unitsFor(const glm::dvec3& force, const glm::dvec3& position,
                                     const glm::dvec3& angles) noexcept;

}  // namespace nearfit::falcon
