#pragma once

#include <array>
#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

/// Local minimum distances by the definition, decided in exact rational arithmetic: for input on which double
/// precision cannot decide. Shares nothing with the engine but the mesh's vertices and triangles.
namespace nearfit::test {

/// A pair of features that carries a minimum, or comes near to it.
struct ExactMinimum {
  std::array<char, 2> features;  ///< 'v', 'e' or 'f', scene first.
  glm::dvec3 scenePoint, partPoint, direction;
  double distance;
  /// Least over all conditions of what is left of each, in units of what the engine promises to resolve: not
  /// below 0 where there is a minimum, above 1 where no rounding within the promise can take it away.
  double margin;
  /// How far along both features the minimum is flat within the promise [m]: near-parallel edges.
  double place;
  /// Least angle by which a direction along a surface would have to turn to lead nearer, or two edges to be
  /// parallel [rad].
  double angle;
  /// How little a face of one is tilted against the other's feature there [rad]: the first of these angles
  /// times, of two edges, the sine at which they cross, as the way from edge to edge is tilted by the more
  /// the slower they cross.
  double tilt;
  /// False for the rim that a flat face shares with others of no common side: no feature of its own; and at a
  /// vertex whose faces pass through each other, where one lobe's outside is another's inside.
  bool isPromised;
  /// Parallel edges or faces, which may carry a flat region: distance and direction of it, from their
  /// middles. Where one of the middles is a little behind the other's face, they count as just before it.
  bool isFlat;
};

/// Two bodies whose minima are asked for at many poses.
class ExactOracle {
 public:
  ExactOracle(const TriangleMesh& scene, const TriangleMesh& part);
  ~ExactOracle();
  ExactOracle(const ExactOracle&) = delete;
  ExactOracle& operator=(const ExactOracle&) = delete;

  /// Minima of points (no flat regions; their corners are minima) with a margin not below `leastMargin` and a
  /// distance in (0, cutoff], in the scene's frame and no order. A point where features meet is there once
  /// for each pair of them. The rotation is that of the quaternion as it is, divided by its length.
  std::vector<ExactMinimum> minima(const RigidTransform& sceneFromPart, double cutoff,
                                   double leastMargin) const;

  /// Sum of the bodies' bounding diagonals [m]: what tolerances are fractions of.
  double size() const;

 private:
  struct Bodies;
  std::unique_ptr<Bodies> bodies_;
};

}  // namespace nearfit::test
