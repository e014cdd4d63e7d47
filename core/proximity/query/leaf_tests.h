#pragma once

#include <algorithm>
#include <cstdint>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/minimum.h"
#include "core/proximity/query/edge_pairs.h"
#include "core/proximity/query/leaf_margins.h"

namespace nearfit {

/// Tests pairs of features against the exact conditions of a minimum, in double precision, closed by the
/// tolerances of tolerances.h. For the vertices of a hierarchy with AcceptanceRule::NormalSpan, the
/// conditions are that rule's. Coordinates are in the trees' centred frames. Real-time safe.
class LeafTests {
 public:
  /// @param sceneFromPart  Between the trees' centred frames.
  /// @param cutoff         [m]
  /// @param relaxation     Angle by which directions may leave the polar cones of either feature [rad].
  ///                       Points may leave their features by this angle times the distance.
  LeafTests(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
            double cutoff, double relaxation = 0.0) noexcept;

  LeafTests(const LeafTests&) = delete;
  LeafTests& operator=(const LeafTests&) = delete;

  /// Sine of the angle between two edges below which the direction between their nearest points is more
  /// accurate than their common perpendicular.
  static constexpr double kNearlyParallel = 1e-4;

  struct Edge {
    glm::dvec3 start, along;  ///< `along` is unit.
    double length;            ///< [m]
  };
  /// @param edge  Index in tree.edges(). The result is in the tree's centred frame.
  static Edge edgeOf(const NormalConeTree& tree, std::uint32_t edge) noexcept;
  /// Returns the vectors from an edge, perpendicular to it, to the third corner of each of its faces [m].
  static std::array<glm::dvec3, 2> inwardOf(const NormalConeTree& tree, std::uint32_t edge,
                                            const Edge& e) noexcept;

  /// Limits for testing pairs of edges by a kernel.
  EdgePairLimits edgePairLimits() const noexcept {
    return {cutoff_, mostDistance_, lengthTolerance_, angularSlackBase_, pointRounding_};
  }
  const RigidTransform& sceneFromPart() const noexcept { return sceneFromPart_; }
  const RigidTransform& partFromScene() const noexcept { return partFromScene_; }

  /// A vertex over a face, in the face's frame.
  struct OverFace {
    glm::dvec3 vertex, normal;  ///< `normal` is the face's, unit.
    double distance;            ///< [m]
    double tilt;                ///< Error of the normal [rad].
  };
  /// Completes test() with relaxation where the part of it that concerns the face holds (FacePairHits).
  bool testOverFace(std::uint32_t sceneLeaf, std::uint32_t partLeaf, const OverFace& over,
                    Minimum& out) const noexcept;

  /// True if the pair of leaf children carries a minimum or a piece of a flat region; then fills `out`.
  bool test(std::uint32_t sceneLeaf, std::uint32_t partLeaf, Minimum& out) const noexcept;

 private:
  /// One of the two bodies, and the poses between its frame and the other's.
  struct Side {
    const NormalConeTree& tree;
    const RigidTransform& otherFromThis;
    const RigidTransform& thisFromOther;
  };
  /// Where two nearly parallel edges run beside each other: an interval along the first [m], and the points
  /// of both edges at its middle.
  struct Overlap {
    double from, to;
    glm::dvec3 onA, onB;
  };
  static Overlap overlapOf(const Edge& a, const Edge& b) noexcept;
  /// True if the edges face each other in one direction over the whole overlap.
  static bool isFlat(double sine, const Overlap& overlap) noexcept;
  /// Min distance between the edges over the overlap [m].
  static double leastDistance(const Edge& a, const Edge& b, const Overlap& overlap) noexcept;
  static void setSegment(const glm::dvec3& from, const glm::dvec3& to, Minimum& out) noexcept;

  /// Accepts or rejects a minimum by the cutoff, to the rounding of its distance, and sets isMarginal if any
  /// condition holds only within rounding.
  /// @param error    Returns the error of the min distance [m]; called only where it can matter.
  /// @param isClear  Returns true if all other conditions hold by more than rounding; not called if relaxed.
  template <class Error, class IsClear>
  bool settle(Error&& error, IsClear&& isClear, Minimum& out) const noexcept {
    if (relaxation_ > 0.0) return out.least <= cutoff_;
    const double most = mostDistance_ - cutoff_;
    bool isClose = false;
    if (!(out.least < cutoff_ - most && out.least > most)) {
      const double e = error();
      if (out.least > cutoff_ + e) return false;
      isClose = !(out.least < cutoff_ - e && out.least > e);
      // No reported distance exceeds the cutoff.
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
  /// @param toPart, toScene  Direction from a to b in the scene's frame, its opposite in the part's frame.
  bool areClearOfEdges(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& partEdge,
                       const glm::dvec3& toPart, const glm::dvec3& toScene, double turn) const noexcept {
    return isClearOfEdge(scene_, a, ea, toPart, turn) && isClearOfEdge(part_, b, partEdge, toScene, turn);
  }

  /// Fills `out` with a point minimum: p on `frame`'s body, q on the other, both in `frame`'s coordinates.
  void accept(const Side& frame, const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& direction,
              double distance, Minimum& out) const noexcept;

  bool vertexFace(const Side& v, std::uint32_t vertex, const Side& f, std::uint32_t face,
                  Minimum& out) const noexcept;
  /// Completes vertexFace(), but for its margins.
  bool vertexOver(const Side& v, std::uint32_t vertex, const Side& f, const OverFace& over,
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

  /// True if direction `d` (unit, in the tree's frame) lies in the closed polar cone of the feature, to
  /// within `slack` [rad] and the rounding of the points that span the cone. As an angle, that rounding grows
  /// as the feature's edges get shorter.
  bool isPolarOfVertex(const NormalConeTree& tree, std::uint32_t vertex, const glm::dvec3& d,
                       double slack) const noexcept;
  /// The same for AcceptanceRule::NormalSpan: `d` lies in the span, and one of the vertex's triangles has its
  /// nearest point there in that direction.
  bool isInSpanOfVertex(const NormalConeTree& tree, std::uint32_t vertex, const glm::dvec3& d,
                        double slack) const noexcept;
  bool isPolarOfEdge(const NormalConeTree& tree, std::uint32_t edge, const Edge& e, const glm::dvec3& d,
                     double slack) const noexcept;
  /// Completes edgeEdge for edges so nearly parallel that their common perpendicular is inaccurate.
  bool nearlyParallelEdges(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& eb, double s,
                           double sine, Minimum& out) const noexcept;
  /// Crossing of two edges' lines: the place along each [m], the sine of their angle, and the errors of their
  /// common perpendicular [rad] and of their distance [m].
  struct Crossing {
    double s, t, sine, turn, error;
    const Edge& partEdge;       ///< The second edge in the part's frame,
    const glm::dvec3& toScene;  ///< and the direction from it to the first there.
  };
  double angularErrorOfCrossing(const Edge& ea, const Edge& eb, double sine) const noexcept;
  bool settleCrossing(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& eb, const Crossing& c,
                      Minimum& out) const noexcept;
  /// If edges cross at so small an angle that the end of one is also a minimum within rounding, turns the
  /// minimum into a region piece that reaches that end, so that the two merge. False if nothing changed.
  bool widenAtEnd(const Edge& ea, const Edge& eb, double s, double sine, Minimum& out) const noexcept;

  double lengthSlack(double distance) const noexcept {
    return lengthTolerance_ + angularSlackBase_ * distance;
  }
  /// Error of a direction between two points [rad]. Two features that share an end and both claim a minimum
  /// there compute the same direction, so they need no more. More would let both ends of an edge claim the
  /// minimum between them, over a nearly parallel edge.
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
  double mostDistance_;  ///< At least the cutoff plus the rounding of any distance [m].
  double lengthTolerance_, angularSlackBase_, pointRounding_;
};

}  // namespace nearfit
