#pragma once

#include <algorithm>
#include <cstdint>

#include "core/math/rigid_transform.h"
#include "core/proximity/edge_pairs.h"
#include "core/proximity/leaf_margins.h"
#include "core/proximity/minimum.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// Exact conditions on pairs of features, in double precision, closed by the tolerances of tolerances.h; of
/// the vertices of a hierarchy by the rule of normal spans, that rule's.
/// Coordinates are those of the trees (relative to their centres). Real-time safe.
class LeafTests {
 public:
  /// @param sceneFromPart  Between the trees' centred frames.
  /// @param relaxation     Directions may be off the polar cones of either feature by so much, points off
  ///                       their features by so much of the distance [rad].
  LeafTests(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
            double cutoff, double relaxation = 0.0) noexcept;

  LeafTests(const LeafTests&) = delete;
  LeafTests& operator=(const LeafTests&) = delete;

  /// Sine below which the direction square to two edges is better known from the points where they are
  /// nearest.
  static constexpr double kNearlyParallel = 1e-4;

  struct Edge {
    glm::dvec3 start, along;  ///< `along` is unit.
    double length;
  };
  static Edge edgeOf(const NormalConeTree& tree, std::uint32_t edge) noexcept;
  /// From an edge, square to it, to the third corner of either of its faces.
  static std::array<glm::dvec3, 2> inwardOf(const NormalConeTree& tree, std::uint32_t edge,
                                            const Edge& e) noexcept;

  /// What a test of pairs of edges by a kernel needs.
  EdgePairLimits edgePairLimits() const noexcept {
    return {cutoff_, mostDistance_, lengthTolerance_, angularSlackBase_, pointRounding_};
  }
  const RigidTransform& sceneFromPart() const noexcept { return sceneFromPart_; }
  const RigidTransform& partFromScene() const noexcept { return partFromScene_; }

  /// Whether the pair of leaf children carries a minimum, or a piece of a flat region; fills `out` if so.
  bool test(std::uint32_t sceneLeaf, std::uint32_t partLeaf, Minimum& out) const noexcept;

 private:
  /// One of the two bodies and how to get from its frame to the other's.
  struct Side {
    const NormalConeTree& tree;
    const RigidTransform& otherFromThis;
    const RigidTransform& thisFromOther;
  };
  /// Where two edges that are nearly parallel run beside each other: along the first, and in the middle of
  /// that the point of each.
  struct Overlap {
    double from, to;
    glm::dvec3 onA, onB;
  };
  static Overlap overlapOf(const Edge& a, const Edge& b) noexcept;
  /// Whether the edges face each other in one direction all along.
  static bool isFlat(double sine, const Overlap& overlap) noexcept;
  static double leastDistance(const Edge& a, const Edge& b, const Overlap& overlap) noexcept;
  static void setSegment(const glm::dvec3& from, const glm::dvec3& to, Minimum& out) noexcept;

  /// Takes what was found in, or not: the cutoff, to the rounding of the distance, and whether any condition
  /// is met by rounding only.
  /// @param error    () to the error of the least distance [m]; asked where it may count.
  /// @param isClear  () to whether all other conditions are met by more than their rounding; asked of minima
  ///                 that are not relaxed.
  template <class Error, class IsClear>
  bool settle(Error&& error, IsClear&& isClear, Minimum& out) const noexcept {
    if (relaxation_ > 0.0) return out.least <= cutoff_;
    const double most = mostDistance_ - cutoff_;
    bool isClose = false;
    if (!(out.least < cutoff_ - most && out.least > most)) {
      const double e = error();
      if (out.least > cutoff_ + e) return false;
      isClose = !(out.least < cutoff_ - e && out.least > e);
      // Nothing that is reported is beyond the cutoff.
      out.least = std::min(out.least, cutoff_);
      if (out.dimension == 0) out.lmd.distance = out.least;
    }
    out.lmd.isMarginal = isClose || !isClear();
    return true;
  }
  static bool isClearOfEdge(const Side& e, std::uint32_t edge, const Edge& line, const glm::dvec3& d,
                            double turn) noexcept {
    return LeafMargins::isClearOfEdge(e.tree, edge, line.start, line.along, line.length, d, turn);
  }
  /// @param toPart, toScene  The direction from a to b in the scene's frame, the opposite in the part's.
  bool areClearOfEdges(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& partEdge,
                       const glm::dvec3& toPart, const glm::dvec3& toScene, double turn) const noexcept {
    return isClearOfEdge(scene_, a, ea, toPart, turn) && isClearOfEdge(part_, b, partEdge, toScene, turn);
  }

  /// A point minimum with p on one side and q on the other, both in `frame`'s coordinates.
  void accept(const Side& frame, const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& direction,
              double distance, Minimum& out) const noexcept;

  bool vertexFace(const Side& v, std::uint32_t vertex, const Side& f, std::uint32_t face,
                  Minimum& out) const noexcept;
  bool vertexEdge(const Side& v, std::uint32_t vertex, const Side& e, std::uint32_t edge,
                  Minimum& out) const noexcept;
  bool vertexVertex(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept;
  bool edgeEdge(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept;
  bool edgeFace(const Side& e, std::uint32_t edge, const Side& f, std::uint32_t face,
                Minimum& out) const noexcept;
  bool faceFace(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept;
  bool parallelEdges(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& eb, const Overlap& overlap,
                     Minimum& out) const noexcept;

  /// Whether direction `d` (unit, the side's frame) lies in the closed polar cone of the feature: to `slack`,
  /// and to the rounding of the points that span it, which is more of an angle the shorter they are.
  bool isPolarOfVertex(const NormalConeTree& tree, std::uint32_t vertex, const glm::dvec3& d,
                       double slack) const noexcept;
  /// The same by the rule of normal spans, when that is the tree's: `d` lies in the span, and the vertex is
  /// where one of its triangles is nearest in that direction.
  bool isInSpanOfVertex(const NormalConeTree& tree, std::uint32_t vertex, const glm::dvec3& d,
                        double slack) const noexcept;
  bool isPolarOfEdge(const NormalConeTree& tree, std::uint32_t edge, const Edge& e, const glm::dvec3& d,
                     double slack) const noexcept;
  /// The rest of edgeEdge where edges are so nearly parallel that the normal of both is not known.
  bool nearlyParallelEdges(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& eb, double s,
                           double sine, Minimum& out) const noexcept;
  /// Where lines cross, how steeply, and the errors of the direction across both [rad] and of their distance.
  struct Crossing {
    double s, t, sine, turn, error;
    const Edge& partEdge;       ///< The second in the part's frame,
    const glm::dvec3& toScene;  ///< and there the direction to the first.
  };
  double turnOfCrossing(const Edge& ea, const Edge& eb, double sine) const noexcept;
  bool settleCrossing(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& eb, const Crossing& c,
                      Minimum& out) const noexcept;
  /// Where edges cross at so small an angle that the end of one, too, is a minimum to rounding, they share a
  /// piece of a region with it: so that they become one. False where it is as it was.
  bool widenAtEnd(const Edge& ea, const Edge& eb, double s, double sine, Minimum& out) const noexcept;

  double lengthSlack(double distance) const noexcept {
    return lengthTolerance_ + angularSlackBase_ * distance;
  }
  /// What a direction between two points can be off by. Two features that share an end and both claim it
  /// there say the same, so no more is needed; more would let both ends of an edge claim what is nearest
  /// between them, over an edge that is nearly parallel to it.
  double directionRounding(double distance) const noexcept {
    return relaxation_ + 2.0 * pointRounding_ / distance;
  }
  double angularSlack(double distance) const noexcept {
    return angularSlackBase_ + pointRounding_ / distance;
  }

  RigidTransform sceneFromPart_, partFromScene_;
  Side scene_, part_;
  LeafMargins margins_;
  double cutoff_, relaxation_;
  double mostDistance_;  ///< No less than the cutoff and any rounding of a distance [m].
  double lengthTolerance_, angularSlackBase_, pointRounding_;
};

}  // namespace nearfit
