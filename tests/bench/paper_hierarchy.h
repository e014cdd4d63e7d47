#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

/// The algorithm of Johnson and Willemsen (2003), 2.3 and 4.2, as a baseline. Shares no code with the engine but
/// the mesh and the pose.
///
/// As in the paper: a binary hierarchy, split as PQP splits, with a sphere and a cone of normals at each node and
/// a triangle at each leaf; pairs of nodes pruned by the cutoff and by cones and the span of directions between
/// spheres; the exact distance of two triangles at the leaves.
///
/// The paper does not print the test at a leaf. Two readings of it are here, one on either side of what the
/// authors can have meant: see PaperRule.
namespace nearfit::bench {

/// Which pairs of triangles within the cutoff count.
enum class PaperRule {
  /// As the data are described: a triangle's cone holds the normals of its face and of its three vertices, and
  /// the segment between the nearest points must lie in both cones.
  NormalCones,
  /// The strictest reading: the segment must lie in the span of the normals of the faces that meet at each of
  /// the nearest points (2.3 has each triangle know its neighbours). Cones also hold the neighbours' normals, so
  /// that pruning loses none.
  NormalSpans,
  /// All pairs, no cones: what 4.1 argues against.
  AllPairs,
};

/// A vertex, edge or triangle of a mesh.
struct PaperFeature {
  enum class Kind : std::uint8_t { Vertex, Edge, Face };
  Kind kind;
  std::uint32_t index;
  auto operator<=>(const PaperFeature&) const = default;
};

/// Where two triangles are nearest.
struct TrianglesNear {
  double distance;  ///< 0 where they meet.
  glm::dvec3 a, b;
  /// 0 to 2: the corner; 3 to 5: the edge from corner k - 3 to the next; 6: the face's inside.
  std::uint8_t placeOnA, placeOnB;
};

/// Nearest points of two triangles: the least over nine pairs of edges and six of a corner and a face; 0 where an
/// edge of one passes through the other.
TrianglesNear nearestOf(const glm::dvec3 (&a)[3], const glm::dvec3 (&b)[3]) noexcept;

/// True if `direction` lies in the span of unit normals: the convex cone that they generate, to within
/// kSpanTolerance.
bool isInSpan(const glm::dvec3& direction, std::span<const glm::dvec3> normals) noexcept;

/// Resolution of directions in the rule's tests [rad]: above rounding (1e-16 of the coordinates over a distance of
/// 1e-8 of them), below what a user sees.
constexpr double kSpanTolerance = 1e-7;

/// Hierarchy of one mesh for one rule.
class PaperHierarchy {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  struct Node {
    glm::dvec3 centre;        ///< Of the sphere [m].
    double radius;            ///< [m]
    glm::dvec3 axis;          ///< Of the cone; unit.
    double cosHalf, sinHalf;  ///< Of the cone's half angle, from 0 to pi.
    std::uint32_t left = kNone, right = kNone;
    std::uint32_t triangle = kNone;  ///< Of a leaf.
    bool isLeaf() const noexcept { return triangle != kNone; }
  };

  /// O(n log n) where splits are even. A mesh without triangles gives no nodes.
  PaperHierarchy(const TriangleMesh& mesh, PaperRule rule);

  const TriangleMesh& mesh() const noexcept { return mesh_; }
  PaperRule rule() const noexcept { return rule_; }
  /// The root first.
  std::span<const Node> nodes() const noexcept { return nodes_; }
  std::size_t byteSize() const noexcept;

  /// Centre of the box around all vertices along the axes of their covariance, as PQP lays it: the paper's
  /// approximation of the centre of mass (4.3) [m].
  const glm::dvec3& boxCentre() const noexcept { return boxCentre_; }

  /// Unit normal of a triangle; zero for one without area.
  const glm::dvec3& faceNormal(std::uint32_t triangle) const noexcept { return faceNormals_[triangle]; }
  /// Feature of a triangle at a place as in TrianglesNear.
  PaperFeature featureAt(std::uint32_t triangle, std::uint8_t place) const noexcept;
  /// True if a unit direction lies in the span of the normals of the faces at a feature.
  bool isInSpanOf(const PaperFeature& feature, const glm::dvec3& direction) const;

 private:
  struct Builder;
  std::uint32_t build(Builder& builder, std::size_t begin, std::size_t end);
  void setBounds(Builder& builder, Node& node, std::size_t begin, std::size_t end);
  std::span<const std::uint32_t> facesAt(std::uint32_t vertex) const noexcept;

  TriangleMesh mesh_;
  PaperRule rule_;
  std::vector<Node> nodes_;
  std::vector<glm::dvec3> faceNormals_, vertexNormals_;
  std::vector<std::uint32_t> vertexFaces_, firstFace_;  ///< Faces of vertex 0, of vertex 1, ...; offsets.
  glm::dvec3 boxCentre_{0.0};
};

/// A pair that the rule accepts; points in the scene's frame.
struct PaperMinimum {
  PaperFeature sceneFeature, partFeature;
  glm::dvec3 scenePoint, partPoint;  ///< [m]
  double distance;                   ///< > 0 [m]
  glm::dvec3 direction;              ///< Unit, from the scene to the part.
};

/// Finds the rule's pairs; keeps its work space from query to query.
class PaperQuery {
 public:
  /// Both hierarchies must be for the same rule, and outlive this.
  PaperQuery(const PaperHierarchy& scene, const PaperHierarchy& part) : scene_(scene), part_(part) {}

  /// Pairs within (0, cutoff], nearest first. By the rules of normals each pair of features once, however many
  /// triangles share it; of AllPairs each pair of triangles.
  /// @param cutoff  [m]; > 0.
  /// Valid until the next call.
  std::span<const PaperMinimum> find(const RigidTransform& sceneFromPart, double cutoff);

  std::size_t nodePairs() const noexcept { return nodePairs_; }  ///< Visited in the last query.
  std::size_t leafPairs() const noexcept { return leafPairs_; }  ///< Triangles tested in the last query.
  /// True if triangles met in the last query: distances then say nothing.
  bool isTouching() const noexcept { return isTouching_; }

 private:
  struct Posed {
    glm::dmat3 rotation;
    glm::dvec3 translation;
    double cutoff;
  };
  bool isPruned(const PaperHierarchy::Node& a, const PaperHierarchy::Node& b,
                const Posed& pose) const noexcept;
  void testLeaves(std::uint32_t a, std::uint32_t b, const PaperHierarchy::Node& leafA,
                  const PaperHierarchy::Node& leafB, const Posed& pose);
  bool isAccepted(const PaperMinimum& minimum, const PaperHierarchy::Node& leafA,
                  const PaperHierarchy::Node& leafB, const Posed& pose) const;

  const PaperHierarchy &scene_, &part_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack_;
  std::vector<PaperMinimum> found_;
  std::size_t nodePairs_ = 0, leafPairs_ = 0;
  bool isTouching_ = false;
};

}  // namespace nearfit::bench
