#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

/// Brute force over all pairs of features, from the definition of a local minimum distance. Shares nothing
/// with the engine but the mesh's vertices and triangles: adjacency, closest points, tangent cones and sides
/// are its own, no feature is dropped, and the only pairs not tested are those whose boxes are farther apart
/// than the cutoff.
namespace nearfit::test {

struct OracleMinimum {
  glm::dvec3 scenePoint, partPoint;
  double distance;
  std::array<char, 2> features;  ///< 'v', 'e' or 'f', scene first.
  /// How far from false the condition is that holds least (cosine, or length over size): a minimum within a
  /// little of zero on either side is one that rounding may add or take away.
  double slack;
};

/// One body: its features with the generators of their tangent cones.
class OracleBody {
 public:
  explicit OracleBody(const TriangleMesh& mesh);

  struct Feature {
    char kind;
    std::vector<glm::dvec3> corners;  ///< 1, 2 or 3.
    std::vector<glm::dvec3>
        tangents;             ///< Unit generators of the tangent cone other than the feature's own span.
    glm::dvec3 outward{0.0};  ///< Any direction with a minimum leaves on its side; zero: no side.
  };
  const std::vector<Feature>& features() const { return features_; }
  double size() const { return size_; }

 private:
  std::vector<Feature> features_;
  double size_ = 0.0;
};

/// A feature at a pose.
OracleBody::Feature moved(const OracleBody::Feature& feature, const RigidTransform& pose);

/// All isolated minima within the cutoff whose slack is above `-margin`, in the scene's frame, in no order.
/// One point can appear several times when its slack is within the margin (found by neighbours).
std::vector<OracleMinimum> bruteForceMinima(const OracleBody& scene, const OracleBody& part,
                                            const RigidTransform& sceneFromPart, double cutoff,
                                            double margin);

}  // namespace nearfit::test
