#include "device/falcon/falcon_kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace nearfit::falcon {
namespace {

using namespace geometry;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Tolerance of the squared lengths [m^2]: about a picometre of the grip's position.
constexpr double kConverged = 1e-13;
/// Longest Newton step [m]: beyond it the legs' circles have turned away from their tangents.
constexpr double kLongestStep = 0.03;
/// Halvings of a step that does not reduce the residual.
constexpr int kMaxHalvings = 10;
/// With a shorter lever, thigh and shin are nearly in line, as good as locked [m].
constexpr double kMinLever = 1e-3;

/// Outward direction of a leg; constant.
struct Leg {
  double cosine, sine;
};
const std::array<Leg, 3> kLegs = [] {
  std::array<Leg, 3> legs{};
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const double angle = (kFirstLeg - 120.0 * static_cast<double>(i)) * kDegree;
    legs[i] = {std::cos(angle), std::sin(angle)};
  }
  return legs;
}();

/// The grip as seen from a leg [m].
struct Seen {
  double out = 0.0;     ///< From the thigh's joint to the shin's end, outwards.
  double along = 0.0;   ///< The same, along z.
  double across = 0.0;  ///< Sideways slant of the bars.
  double bars = 0.0;    ///< Length of the bars seen from the side; NaN if they are too short.
  double shin() const noexcept { return kShinJoints + bars; }
};

Seen seenBy(const Leg& leg, const glm::dvec3& p) noexcept {
  Seen seen;
  seen.out = leg.cosine * p.x + leg.sine * p.y - kBaseOut + kGripOut;
  seen.across = -leg.sine * p.x + leg.cosine * p.y - kBaseAcross + kGripAcross;
  seen.along = p.z;
  seen.bars = std::sqrt(kShin * kShin - seen.across * seen.across);
  return seen;
}

/// A leg's equation, squared: its residual and how that changes.
struct Residual {
  double value = 0.0;        ///< [m^2]
  glm::dvec3 gradient{0.0};  ///< With respect to the grip's position [m].
  double shinAlong = 0.0;    ///< The shin's extent along z [m].
  double lever = 0.0;        ///< The shin's extent across the thigh [m].
};

Residual residualOf(const Leg& leg, const glm::dvec3& p, double angle) noexcept {
  const Seen seen = seenBy(leg, p);
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const double out = seen.out - kThigh * cosine, along = seen.along - kThigh * sine;
  const double shin = seen.shin();
  // Half the derivatives by u, v and w are out, byAcross and along.
  const double byAcross = shin * seen.across / seen.bars;
  Residual residual;
  residual.value = out * out + along * along - shin * shin;
  residual.gradient =
      2.0 * glm::dvec3(leg.cosine * out - leg.sine * byAcross, leg.sine * out + leg.cosine * byAcross, along);
  residual.shinAlong = along;
  residual.lever = cosine * along - sine * out;
  return residual;
}

using Residuals = std::array<Residual, 3>;

Residuals residualsOf(const glm::dvec3& p, const glm::dvec3& angles) noexcept {
  return {residualOf(kLegs[0], p, angles.x), residualOf(kLegs[1], p, angles.y),
          residualOf(kLegs[2], p, angles.z)};
}

/// Returns the largest absolute residual; NaN if one is NaN.
double sizeOf(const Residuals& residuals) noexcept {
  double size = 0.0;
  for (const Residual& each : residuals) {
    if (!(std::abs(each.value) <= size)) size = std::abs(each.value);
  }
  return size;
}

/// Returns the matrix with these rows, one per leg.
glm::dmat3 rows(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept {
  return glm::transpose(glm::dmat3(a, b, c));
}

glm::dvec3 newtonStep(const Residuals& at) noexcept {
  const glm::dvec3 values(at[0].value, at[1].value, at[2].value);
  glm::dvec3 step = -(glm::inverse(rows(at[0].gradient, at[1].gradient, at[2].gradient)) * values);
  const double length = glm::length(step);
  if (length > kLongestStep) step *= kLongestStep / length;
  return step;
}

bool isPossible(const Residuals& at) noexcept {
  return std::all_of(at.begin(), at.end(),
                     [](const Residual& each) { return each.shinAlong > 0.0 && each.lever > kMinLever; });
}

std::optional<glm::dvec3> search(const glm::dvec3& angles, glm::dvec3 p) noexcept {
  Residuals at = residualsOf(p, angles);
  for (int i = 0; i < kMaxIterations; ++i) {
    const double size = sizeOf(at);
    if (!std::isfinite(size)) return std::nullopt;
    if (size <= kConverged) return isPossible(at) ? std::optional(p) : std::nullopt;
    glm::dvec3 step = newtonStep(at);
    int halvings = 0;
    // Out of reach the residual is NaN, which counts as no decrease.
    for (Residuals next = residualsOf(p + step, angles); !(sizeOf(next) < size);
         next = residualsOf(p + step, angles)) {
      if (++halvings > kMaxHalvings) return std::nullopt;
      step *= 0.5;
    }
    p += step;
    at = residualsOf(p, angles);
  }
  return std::nullopt;
}

}  // namespace

glm::dvec3 anglesOf(const std::array<std::int16_t, 3>& encoders) noexcept {
  const auto of = [](std::int16_t counts) {
    return (kAngleAtIndex + 360.0 / (4.0 * kSlots) / kGearRatio * counts) * kDegree;
  };
  return {of(encoders[0]), of(encoders[1]), of(encoders[2])};
}

bool isInRange(const glm::dvec3& angles) noexcept {
  for (int i = 0; i < 3; ++i) {
    if (!(angles[i] >= kMinAngle && angles[i] <= kMaxAngle)) return false;
  }
  return true;
}

std::optional<glm::dvec3> inverse(const glm::dvec3& position) noexcept {
  glm::dvec3 angles(0.0);
  for (int i = 0; i < 3; ++i) {
    const Seen seen = seenBy(kLegs[static_cast<std::size_t>(i)], position);
    // Law of cosines in the triangle that thigh and shin span.
    const double third = std::hypot(seen.out, seen.along), shin = seen.shin();
    const double cosine = (third * third + kThigh * kThigh - shin * shin) / (2.0 * third * kThigh);
    if (!(std::abs(cosine) <= 1.0)) return std::nullopt;
    angles[i] = std::atan2(seen.along, seen.out) - std::acos(cosine);
  }
  return angles;
}

std::optional<glm::dvec3> forward(const glm::dvec3& angles, const glm::dvec3& start) noexcept {
  if (const auto found = search(angles, start)) return found;
  return search(angles, kCentre);
}

glm::dmat3 jacobian(const glm::dvec3& position, const glm::dvec3& angles) noexcept {
  // By the implicit function theorem: the residual falls by 2 a lever per radian of the thigh.
  const Residuals at = residualsOf(position, angles);
  const auto row = [](const Residual& each) { return each.gradient / (2.0 * kThigh * each.lever); };
  return glm::inverse(rows(row(at[0]), row(at[1]), row(at[2])));
}

std::array<std::int16_t, 3> unitsFor(const glm::dvec3& force, const glm::dvec3& position,
                                     const glm::dvec3& angles) noexcept {
  // Motor units count against the thigh angles.
  glm::dvec3 units = -kUnitsPerNewtonMetre * (glm::transpose(jacobian(position, angles)) * force);
  const double maxUnit = std::max({std::abs(units.x), std::abs(units.y), std::abs(units.z)});
  if (!std::isfinite(units.x + units.y + units.z)) return {};
  if (maxUnit > kMaxUnits) units *= kMaxUnits / maxUnit;
  return {static_cast<std::int16_t>(units.x), static_cast<std::int16_t>(units.y),
          static_cast<std::int16_t>(units.z)};
}

}  // namespace nearfit::falcon
