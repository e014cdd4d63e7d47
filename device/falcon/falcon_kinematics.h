#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace nearfit::falcon {

/// Kinematics of the Novint Falcon: three legs about z, each a thigh on a motor and a shin of two parallel
/// bars, which keep the grip from turning (a translational platform after Tsai and Stamper). x to the right,
/// y up, z towards the user; the origin is the middle of the thighs' joints. [m], [rad]. Real-time safe.
///
/// In the frame of a leg, u points outwards from the axis, v across and w along z. With the grip at (u, v,
/// w), q = (u - r + c, w) and the thigh's end k = a (cos t, sin t),
///
///     |q - k| = d + e + sqrt(b^2 - (v - s + f)^2)
///
/// Source: Stamper, "A three degree of freedom parallel manipulator with only translational degrees of
/// freedom", PhD 97-4, Maryland 1997, for the geometry; libnifalcon for its measures. The solutions are ours.
namespace geometry {
constexpr double kThigh = 0.060;              ///< a
constexpr double kShin = 0.1025;              ///< b
constexpr double kGripOut = 0.014;            ///< c: outwards, from the shin's end to the grip's middle.
constexpr double kShinJoints = 0.0225;        ///< d + e: from thigh to bars, and from bars to grip.
constexpr double kGripAcross = -0.025;        ///< f: the same as kGripOut, across.
constexpr double kBaseOut = 0.037233758;      ///< r: outwards, from the axis to the thigh's joint.
constexpr double kBaseAcross = -0.027330909;  ///< s: the same, across.
constexpr double kFirstLeg = 105.0;     ///< Angle of the first leg about z [degrees]; each next is 120 less.
constexpr double kAngleAtIndex = 35.0;  ///< Thigh angle at encoder count 0 [degrees].
constexpr double kSlots = 320;          ///< Slots in an encoder's wheel; four counts each.
constexpr double kGearRatio = 0.110 / 0.01425;  ///< Drum diameter: thigh's over motor's.
}  // namespace geometry

/// Range of the thighs over the whole workspace, four inches each way, with some margin [rad]. Beyond it an
/// encoder has not found its index.
constexpr double kMinAngle = -1.0, kMaxAngle = 2.1;

/// Motor units per newton metre on a thigh, in the direction that turns it back (libnifalcon), and
/// the largest command. No source gives that limit; it is well above what the maker's nine newtons
/// need near the middle.
constexpr double kUnitsPerNewtonMetre = 10'000.0;
constexpr int kMaxUnits = 4096;

/// Middle of the workspace.
constexpr glm::dvec3 kCentre{0.0, 0.0, 0.125};

/// Returns the thigh angles for encoder counts from the indexes.
glm::dvec3 anglesOf(const std::array<std::int16_t, 3>& encoders) noexcept;
/// True if every angle is from kMinAngle to kMaxAngle.
bool isInRange(const glm::dvec3& angles) noexcept;

/// Returns the thigh angles for a grip position, knees outwards, in closed form; std::nullopt
/// beyond the legs' reach.
std::optional<glm::dvec3> inverse(const glm::dvec3& position) noexcept;

/// Finds the grip position for the thigh angles, in front of the knees, by Newton's method.
///
/// @param start  A position near it, such as the last one. If that leads nowhere, the search
///               begins again at kCentre.
/// @return std::nullopt if it does not converge within kMaxIterations, or converges to a pose that the
///         device cannot have (knees inwards, grip behind them). Every result is checked: it fulfils the
///         legs' equations to rounding and is not singular.
std::optional<glm::dvec3> forward(const glm::dvec3& angles, const glm::dvec3& start) noexcept;
constexpr int kMaxIterations = 30;

/// Returns the motion of the grip per radian of each thigh [m/rad], one column per thigh. Not
/// finite where singular.
/// @param angles  Thigh angles at `position`.
glm::dmat3 jacobian(const glm::dvec3& position, const glm::dvec3& angles) noexcept;

/// Returns the motor commands that make the grip push with `force` [N]: J^T f, by virtual work. If one
/// exceeds kMaxUnits, all shrink alike to keep the direction. Zeros where singular.
std::array<std::int16_t, 3> unitsFor(const glm::dvec3& force, const glm::dvec3& position,
                                     const glm::dvec3& angles) noexcept;

}  // namespace nearfit::falcon
