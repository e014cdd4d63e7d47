#include "tests/bench/analytic_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

namespace nearfit::bench {
namespace {

constexpr glm::dvec3 kUp{0.0, 0.0, 1.0};
const glm::dmat3 kFlat(0.0);

/// Cosines and differences of heights below this are zero but for the rounding of a pose.
constexpr double kParallel = 1e-9;

glm::dmat3 roundShape(double radius) {
  return glm::dmat3(1.0 / radius);
}

/// A point of the part above the floor.
TrueContact aboveFloor(const glm::dvec3& lowest, double spread, double reach = 0.0) {
  return {{lowest.x, lowest.y, 0.0}, lowest, kUp, lowest.z, spread, reach};
}

/// The largest and the smallest factor by which a matrix stretches.
std::array<double, 2> stretches(const glm::dmat2& m) {
  const double sum = std::hypot(m[0][0] + m[1][1], m[0][1] - m[1][0]);
  const double difference = std::hypot(m[0][0] - m[1][1], m[0][1] + m[1][0]);
  return {0.5 * (sum + difference), 0.5 * std::abs(sum - difference)};
}

glm::dvec3 nearestOnCircle(const Torus& torus, const glm::dvec3& point) {
  const glm::dvec3 offset = point - torus.centre;
  const glm::dvec3 inPlane = offset - glm::dot(offset, torus.axis) * torus.axis;
  return torus.centre + torus.majorRadius * glm::normalize(inPlane);
}

/// Curved about the axis, straight along it, beside the segment; round beyond its ends.
glm::dmat3 capsuleShape(const Capsule& capsule, double position) {
  if (position <= 0.0 || position >= 1.0) return roundShape(capsule.radius);
  const glm::dvec3 axis = glm::normalize(capsule.end - capsule.start);
  return (glm::dmat3(1.0) - glm::outerProduct(axis, axis)) / capsule.radius;
}

/// Where two segments are nearest, as fractions of their lengths: where the lines are, or else on a border of
/// the square of fractions, where one segment's end is nearest to the other.
std::array<double, 2> nearestOnSegments(const Capsule& a, const Capsule& b) {
  const glm::dvec3 u = a.end - a.start, v = b.end - b.start, w = b.start - a.start;
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), uv = glm::dot(u, v);
  const double uw = glm::dot(u, w), vw = glm::dot(v, w);
  const double determinant = uu * vv - uv * uv;
  const std::array<double, 2> onLines{(uw * vv - vw * uv) / determinant, (uw * uv - vw * uu) / determinant};
  const auto isInside = [](double x) { return x >= 0.0 && x <= 1.0; };
  if (isInside(onLines[0]) && isInside(onLines[1])) return onLines;
  std::array<double, 2> best{};
  double least = INFINITY;
  const auto consider = [&](double s, double t) {
    const double distance = glm::length(w + t * v - s * u);
    if (distance >= least) return;
    least = distance;
    best = {s, t};
  };
  for (const double end : {0.0, 1.0}) {
    consider(end, std::clamp((end * uv - vw) / vv, 0.0, 1.0));
    consider(std::clamp((uw + end * uv) / uu, 0.0, 1.0), end);
  }
  return best;
}

}  // namespace

double contactSpread(const glm::dmat3& sceneShape, const glm::dmat3& partShape, const glm::dvec3& direction,
                     double distance) {
  const glm::dvec3 aside =
      std::abs(direction.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 e1 = glm::normalize(glm::cross(direction, aside)), e2 = glm::cross(direction, e1);
  const auto inPlane = [&](const glm::dmat3& shape) {
    return glm::dmat2(glm::dot(e1, shape * e1), glm::dot(e2, shape * e1), glm::dot(e1, shape * e2),
                      glm::dot(e2, shape * e2));
  };
  const glm::dmat2 a = inPlane(sceneShape), b = inPlane(partShape);
  const double aNorm = stretches(a)[0], bNorm = stretches(b)[0];
  return (aNorm * (1.0 + distance * bNorm) + bNorm) / stretches(a + b + distance * (a * b))[1];
}

TrueContact sphereSphere(const Sphere& scene, const Sphere& part) {
  const glm::dvec3 offset = part.centre - scene.centre;
  const double length = glm::length(offset), distance = length - scene.radius - part.radius;
  const glm::dvec3 u = offset / length;
  return {scene.centre + scene.radius * u, part.centre - part.radius * u, u, distance,
          contactSpread(roundShape(scene.radius), roundShape(part.radius), u, distance)};
}

TrueContact floorSphere(const Sphere& part) {
  return aboveFloor(part.centre - part.radius * kUp, 1.0);
}

TrueContact floorEllipsoid(const glm::dvec3& halfAxes, const RigidTransform& sceneFromPart) {
  const glm::dvec3 down = glm::conjugate(sceneFromPart.rotation) * -kUp;
  // x.down is greatest on |x / halfAxes| = 1 at x = halfAxes^2 down / |halfAxes down|.
  const glm::dvec3 lowest = halfAxes * halfAxes * down / glm::length(halfAxes * down);
  // Curvatures of F = |x / halfAxes|^2 = 1: the second derivative of F over the length of its gradient.
  const glm::dvec3 gradient = 2.0 * lowest / (halfAxes * halfAxes);
  glm::dmat3 shape(0.0);
  for (int i = 0; i < 3; ++i)
    shape[i][i] = 2.0 / (halfAxes[i] * halfAxes[i]) / glm::length(gradient);
  return aboveFloor(sceneFromPart.applyToPoint(lowest), contactSpread(kFlat, shape, down, 0.0));
}

TrueContact floorCylinder(double radius, double height, const RigidTransform& sceneFromPart) {
  const glm::dvec3 axis = sceneFromPart.rotation * kUp, centre = sceneFromPart.translation;
  if (std::abs(axis.z) < kParallel) return aboveFloor(centre - radius * kUp, 1.0, 0.5 * height);
  const glm::dvec3 cap = centre - std::copysign(0.5 * height, axis.z) * axis;
  const glm::dvec3 down = axis.z * axis - kUp;  // Within the cap.
  const double length = glm::length(down);
  if (length < kParallel) return aboveFloor(cap, 1.0, radius);
  return aboveFloor(cap + radius / length * down, 1.0);
}

TrueContact floorBox(const glm::dvec3& size, const RigidTransform& sceneFromPart) {
  glm::dvec3 lowest = sceneFromPart.translation;
  double reachSquared = 0.0;
  for (int i = 0; i < 3; ++i) {
    glm::dvec3 halfSide(0.0);
    halfSide[i] = 0.5 * size[i];
    halfSide = sceneFromPart.rotation * halfSide;
    if (std::abs(halfSide.z) < kParallel * size[i]) {
      reachSquared += glm::dot(halfSide, halfSide);
    } else {
      lowest -= std::copysign(1.0, halfSide.z) * halfSide;
    }
  }
  return aboveFloor(lowest, 1.0, std::sqrt(reachSquared));
}

std::optional<TrueContact> floorCone(double radius, double height, const RigidTransform& sceneFromPart) {
  const glm::dvec3 axis = sceneFromPart.rotation * kUp, base = sceneFromPart.translation;
  const glm::dvec3 apex = base + height * axis, down = axis.z * axis - kUp;
  const double length = glm::length(down);
  const glm::dvec3 rim = length < kParallel ? base : base + radius / length * down;
  if (std::abs(rim.z - apex.z) < kParallel * height) return std::nullopt;
  if (apex.z < rim.z) return aboveFloor(apex, 1.0);
  return aboveFloor(rim, 1.0, length < kParallel ? radius : 0.0);
}

/// Round along the tube, and about the axis as far as the point stands out of the circle.
glm::dmat3 tubeShape(const Torus& torus, const glm::dvec3& onCircle, const glm::dvec3& normal) {
  const glm::dvec3 outward = (onCircle - torus.centre) / torus.majorRadius;
  const glm::dvec3 along = glm::cross(torus.axis, outward), across = glm::cross(along, normal);
  const double cosine = glm::dot(normal, outward);
  return glm::outerProduct(across, across) / torus.minorRadius +
         glm::outerProduct(along, along) * (cosine / (torus.majorRadius + torus.minorRadius * cosine));
}

TrueContact torusSphere(const Torus& scene, const Sphere& part) {
  const glm::dvec3 onCircle = nearestOnCircle(scene, part.centre);
  TrueContact contact = sphereSphere({onCircle, scene.minorRadius}, part);
  contact.spread = contactSpread(tubeShape(scene, onCircle, contact.direction), roundShape(part.radius),
                                 contact.direction, contact.distance);
  return contact;
}

TrueContact hollowSphere(const Sphere& hollow, const Sphere& part) {
  const glm::dvec3 out = glm::normalize(part.centre - hollow.centre);
  const double distance = hollow.radius - part.radius - glm::distance(part.centre, hollow.centre);
  return {hollow.centre + hollow.radius * out, part.centre + part.radius * out, -out, distance,
          contactSpread(roundShape(-hollow.radius), roundShape(part.radius), out, distance)};
}

TrueContact capsuleCapsule(const Capsule& scene, const Capsule& part) {
  const auto [s, t] = nearestOnSegments(scene, part);
  TrueContact contact = sphereSphere({scene.start + s * (scene.end - scene.start), scene.radius},
                                     {part.start + t * (part.end - part.start), part.radius});
  contact.spread =
      contactSpread(capsuleShape(scene, s), capsuleShape(part, t), contact.direction, contact.distance);
  return contact;
}

Wrench trueWrench(std::span<const TrueContact> contacts, double cutoff, double stiffness,
                  const glm::dvec3& centre) {
  Wrench sum;
  for (const TrueContact& contact : contacts) {
    if (contact.distance >= cutoff) continue;
    const glm::dvec3 force = stiffness * (cutoff - contact.distance) * contact.direction;
    sum.force += force;
    sum.torque += glm::cross(contact.partPoint - centre, force);
  }
  return sum;
}

}  // namespace nearfit::bench
