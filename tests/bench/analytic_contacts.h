#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/haptics/spring_law.h"
#include "core/math/rigid_transform.h"

/// Local minimum distances between solids, from formulas. In the scene's frame; solids stand apart.
namespace nearfit::bench {

/// One of them: a point, or a flat region, for which its centroid stands.
struct TrueContact {
  glm::dvec3 scenePoint{0.0}, partPoint{0.0};
  glm::dvec3 direction{0.0};  ///< Unit, from scene to part.
  double distance = 0.0;      ///< > 0 [m].
  /// How far the minimum of two tessellations may be from it, as a multiple of the edge length: see
  /// contactSpread.
  double spread = 1.0;
  double reach = 0.0;  ///< Of a region: from the centroid to its farthest point [m].
};

struct Sphere {
  glm::dvec3 centre;
  double radius;
};

/// The tube about a circle.
struct Torus {
  glm::dvec3 centre, axis;  ///< Unit.
  double majorRadius, minorRadius;
};

/// What is within `radius` of a segment.
struct Capsule {
  glm::dvec3 start, end;
  double radius;
};

TrueContact sphereSphere(const Sphere& scene, const Sphere& part);

/// The scene is all that is below z = 0.
TrueContact floorSphere(const Sphere& part);
TrueContact floorEllipsoid(const glm::dvec3& halfAxes, const RigidTransform& sceneFromPart);
/// About its z axis, in the middle. Tilted it stands on a point of its rim, lying on a line.
TrueContact floorCylinder(double radius, double height, const RigidTransform& sceneFromPart);
/// A region when a face or an edge is parallel to the floor.
TrueContact floorBox(const glm::dvec3& size, const RigidTransform& sceneFromPart);
/// Base at its z = 0, apex at z = height. Nothing when apex and rim are equally low: it lies on a line.
std::optional<TrueContact> floorCone(double radius, double height, const RigidTransform& sceneFromPart);

/// The sphere's centre is not on the axis of the torus: the circle nearest to it is then no minimum of
/// points.
TrueContact torusSphere(const Torus& scene, const Sphere& part);

/// The scene is the inside of a sphere, its surface seen from within. The part's centre is not its centre.
TrueContact hollowSphere(const Sphere& hollow, const Sphere& part);

/// Of capsules that are not parallel.
TrueContact capsuleCapsule(const Capsule& scene, const Capsule& part);

/// Shape operator of a torus where the outer normal is `normal`, in the section at `onCircle` [1/m].
glm::dmat3 tubeShape(const Torus& torus, const glm::dvec3& onCircle, const glm::dvec3& normal);

/// All, nearest first; linked rings have two or more. The distance between the circles is a function of two
/// angles; each of its minima on a grid is refined by Newton's method to the rounding of doubles. Tubes are
/// unions of balls about the circles' points, so that their minima are those of the circles less both radii.
std::vector<TrueContact> torusTorus(const Torus& scene, const Torus& part);

/// Linear springs of a rest length of `cutoff`, one on each contact nearer than that; torque about `centre`.
Wrench trueWrench(std::span<const TrueContact> contacts, double cutoff, double stiffness,
                  const glm::dvec3& centre);

/// How sensitive a minimum is to the normals' errors.
///
/// Facets of edges h have normals wrong by up to |A| h and |B| h, with A and B the shape operators (positive
/// where the solid bulges). The segment must be normal to both surfaces; to first order in the way x that the
/// scene's point moves, (A + B + d A B) x is what their normals' errors make up for, so that
/// |x| <= |(A + B + d A B)^-1| (|A| (1 + d |B|) + |B|) h. All minima that facets make of one lie in there:
/// where the surfaces nearly conform there are several, none far.
///
/// @param sceneShape, partShape  Shape operators [1/m], as symmetric tensors; only what is square to
///                               `direction` counts.
double contactSpread(const glm::dmat3& sceneShape, const glm::dmat3& partShape, const glm::dvec3& direction,
                     double distance);

}  // namespace nearfit::bench
