#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/math/triangle_corners.h"
#include "core/proximity/surface/near_faces.h"

/// Straight motions of a body without rotation, by separating axes of moving convex bodies (S. Gottschalk's, in
/// D. Eberly's dynamic form).
namespace nearfit {

/// The range of a straight motion on which no tested axis separates two convex bodies.
struct SweepStretch {
  /// Travel along the direction [m].
  double from = 0.0, to = std::numeric_limits<double>::infinity();

  bool isEmpty() const noexcept { return from > to; }

  /// Changes that an axis made.
  struct Cut {
    bool isFirst = false;  ///< It now determines where they begin to meet.
    bool isLast = false;   ///< It now determines where they part.
  };
  /// Removes the range on which an axis separates them.
  /// @param gap    From the fixed body's upper end on the axis to the moving one's lower end, at the start.
  /// @param depth  From the fixed body's lower end to the moving one's upper end.
  /// @param speed  Of the moving body along the axis.
  Cut cut(double gap, double depth, double speed) noexcept {
    if (speed == 0.0) {
      if (gap > 0.0 || depth < 0.0) to = -1.0;
      return {};
    }
    const double enter = speed < 0.0 ? -gap / speed : -depth / speed;
    const double leave = speed < 0.0 ? -depth / speed : -gap / speed;
    Cut cut;
    if (leave < to) {
      to = leave;
      cut.isLast = true;
    }
    if (enter > from) {
      from = enter;
      cut.isFirst = true;
    }
    return cut;
  }
};

/// The range of a straight motion on which two triangles meet.
struct TriangleSweep {
  SweepStretch stretch;  ///< Empty if they never meet.
  /// Normal of the plane in which they first touch, against the direction; unit. Zero if they meet at the start.
  glm::dvec3 firstNormal{0.0};
  /// Normal of the plane in which they touch last, along the direction, so that the moving one is in front of it; unit.
  /// Zero if no axis ends the range.
  glm::dvec3 lastNormal{0.0};
};

/// Finds where on its way along `direction`, without rotation, `moving` meets `fixed`. A triangle is the convex hull of
/// its corners; both sides count.
///
/// @param direction  Unit.
/// @param within     Max travel of interest; a range that begins beyond it may be returned as empty.
/// Outside the range the triangles are apart, up to rounding of the corners. If rounding alone decides a grazing
/// motion, they touch. All axes count, also those in the triangles' planes for parallel pairs.
TriangleSweep sweepTriangles(const TriangleCorners& fixed, const TriangleCorners& moving,
                             const glm::dvec3& direction, double within) noexcept;

/// A box of a hierarchy, in the scene's centred frame.
struct SweptBox {
  glm::dvec3 centre{0.0};
  glm::dmat3 axes{1.0};  ///< Columns.
  glm::dvec3 half{0.0};
  double size() const noexcept { return half.x + half.y + half.z; }
};

/// A child of a node with faces below it.
struct SweptEntry {
  std::uint32_t child = 0;
  SweptBox box;
};

/// Two bodies of which one moves straight. Not thread-safe.
class StraightSweep {
 public:
  /// @param scene, part    Not empty; kept by reference.
  /// @param sceneFromPart  At the start; finite, unit quaternion.
  StraightSweep(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart);

  /// Children of a node that are faces or may have some below them. Kept: the entries stay where they are. Allocates when
  /// a node is asked for the first time.
  std::span<const SweptEntry> sceneChildren(std::uint32_t node);
  std::span<const SweptEntry> partChildren(std::uint32_t node);
  /// Range in which the boxes may meet, within `within`; std::nullopt if they do not. Holds that of all that they hold.
  std::optional<SweepStretch> meeting(const SweptBox& scene, const SweptBox& part,
                                      const glm::dvec3& direction, double within) const noexcept;
  const PlacedFaces& placed() const noexcept { return placed_; }

 private:
  /// Children of each node; empty until they are asked for.
  using KeptChildren = std::vector<std::vector<SweptEntry>>;

  const NormalConeTree &scene_, &part_;
  PlacedFaces placed_;
  glm::dmat3 turn_;
  double slack_;
  KeptChildren keptOfScene_, keptOfPart_;
};

/// Opens one of two entries that are not both leaves, the larger: calls visit(scene entry, part entry) for each of the
/// pairs that stand for the two.
template <class Visit>
void openLarger(StraightSweep& sweep, const SweptEntry& scene, const SweptEntry& part, Visit&& visit) {
  const bool isSceneLeaf = NormalConeTree::isLeaf(scene.child);
  const bool isPartLeaf = NormalConeTree::isLeaf(part.child);
  if (isPartLeaf || (!isSceneLeaf && scene.box.size() > part.box.size())) {
    for (const SweptEntry& s : sweep.sceneChildren(NormalConeTree::nodeIndex(scene.child)))
      visit(s, part);
  } else {
    for (const SweptEntry& p : sweep.partChildren(NormalConeTree::nodeIndex(part.child)))
      visit(scene, p);
  }
}

}  // namespace nearfit
