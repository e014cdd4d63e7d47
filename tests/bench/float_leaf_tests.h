#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/minimum.h"

namespace nearfit::bench {

/// A hierarchy with its corners in single precision, relative to its centre.
struct FloatBody {
  explicit FloatBody(const NormalConeTree& bodyTree);

  const NormalConeTree& tree;
  std::vector<glm::vec3> positions;
  float size;  ///< [m]
};

/// The exact conditions of LeafTests, evaluated in single precision: what the engine would say if it took
/// that for good enough. Tolerances are as many roundings as there or fewer: more would let in more.
class FloatLeafTests {
 public:
  /// @param sceneFromPart  Between the trees' centred frames.
  FloatLeafTests(const FloatBody& scene, const FloatBody& part, const RigidTransform& sceneFromPart,
                 double cutoff) noexcept;

  FloatLeafTests(const FloatLeafTests&) = delete;
  FloatLeafTests& operator=(const FloatLeafTests&) = delete;

  bool test(std::uint32_t sceneLeaf, std::uint32_t partLeaf, Minimum& out) const noexcept;

  /// Points nearer than this, as a fraction of the bodies' size, are one.
  static constexpr double kLengthTolerance = 1e-6;

 private:
  struct Motion {
    glm::mat3 rotation;
    glm::vec3 translation;
    glm::vec3 point(const glm::vec3& p) const noexcept { return rotation * p + translation; }
    glm::vec3 vector(const glm::vec3& v) const noexcept { return rotation * v; }
  };
  struct Side {
    const FloatBody& body;
    const Motion &otherFromThis, &thisFromOther;
  };
  struct Edge {
    glm::vec3 start, along;
    float length;
  };
  static Motion motionOf(const RigidTransform& pose) noexcept;
  static Edge edgeOf(const FloatBody& body, std::uint32_t edge) noexcept;
  static const glm::vec3& vertexOf(const FloatBody& body, std::uint32_t vertex) noexcept;

  bool accept(const Side& frame, const glm::vec3& p, const glm::vec3& q, const glm::vec3& direction,
              float distance, Minimum& out) const noexcept;
  bool vertexFace(const Side& v, std::uint32_t vertex, const Side& f, std::uint32_t face,
                  Minimum& out) const noexcept;
  bool vertexEdge(const Side& v, std::uint32_t vertex, const Side& e, std::uint32_t edge,
                  Minimum& out) const noexcept;
  bool vertexVertex(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept;
  bool edgeEdge(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept;
  bool parallelEdges(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& eb,
                     Minimum& out) const noexcept;
  bool edgeFace(const Side& e, std::uint32_t edge, const Side& f, std::uint32_t face,
                Minimum& out) const noexcept;
  bool faceFace(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept;
  static void setSegment(const glm::dvec3& from, const glm::dvec3& to, Minimum& out) noexcept;

  bool isPolarOfVertex(const FloatBody& body, std::uint32_t vertex, const glm::vec3& d,
                       float slack) const noexcept;
  bool isPolarOfEdge(const FloatBody& body, std::uint32_t edge, const Edge& e, const glm::vec3& d,
                     float slack) const noexcept;
  float lengthSlack(float distance) const noexcept;
  float angularSlack(float distance) const noexcept;

  Motion sceneFromPart_, partFromScene_;
  Side scene_, part_;
  float cutoff_, lengthTolerance_, pointRounding_;
};

}  // namespace nearfit::bench
