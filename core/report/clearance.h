#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/proximity/overlap/interference.h"
#include "core/scene/scene.h"
#include "core/servo/servo_snapshot.h"

namespace nearfit {

/// Clearance between one part, or a group that moves as one, and another. World frame.
struct PartClearance {
  PartId part{};  ///< The queried part; of a group the one that is nearest to the other.
  PartId other{};
  /// Min distance between the surfaces, regardless of the cutoff [m]; 0 if the parts overlap or touch.
  double distance = 0.0;
  /// Nearest points of the surfaces, on the queried part and on the other [m]; on the surfaces even if one
  /// part is inside the other.
  glm::dvec3 partPoint{0.0}, otherPoint{0.0};
  std::size_t minima = 0;      ///< Number of LMDs within the cutoff; 0 if the parts overlap.
  bool isEveryMinimum = true;  ///< False if there are more minima than the search holds.
  /// True if `distance` is a lower bound: a minimum nearer than those found may be missing.
  bool isDistanceBound = false;
  /// Exact (interference.h); its `scene` is the other part. Parts that touch meet too.
  InterferenceKind overlap = InterferenceKind::Disjoint;
  /// True if they touch (PairSeparation::isTouching).
  bool isTouching = false;
  /// True if both are solid throughout: then the min LMD equals the min distance.
  bool isBetweenSolids = false;

  /// True if they meet and do not only touch.
  bool isOverlapping() const noexcept { return overlap != InterferenceKind::Disjoint && !isTouching; }
};

/// Clearances of a part to all other visible parts, in scene order. Empty if the part's mesh is empty.
/// @param cutoff  For counting minima [m]; finite, > 0.
/// Blocking (milliseconds per pair; builds missing hierarchies): not for the GUI thread. Throws UsageError if
/// there is no such part or the cutoff is invalid; Cancelled, between two pairs.
std::vector<PartClearance> clearancesOf(const Scene& scene, PartId part, double cutoff,
                                        const ProgressCallback& progress = {});

/// Clearances of parts that move as one to all visible parts that are not among them: for each the nearest of the
/// visible ones, with the minima of all. Otherwise the same.
std::vector<PartClearance> clearancesOf(const Scene& scene, const std::vector<PartId>& body, double cutoff,
                                        const ProgressCallback& progress = {});

/// Updates clearances of the moving part, or of the moving group, from a servo tick, for pairs of solids within its
/// cutoff. Leaves other pairs as they are, also parts that overlap the moving one; leaves all if the tick does not know
/// which overlap. Fast enough for the GUI thread.
void updateFrom(const ServoSnapshot& snapshot, std::vector<PartClearance>& clearances) noexcept;

/// "no", "surfaces meet", "inside the other" or "the other inside".
const char* nameOf(InterferenceKind overlap) noexcept;

/// The clearances as CSV (UTF-8), one row each: `part` (of a group the nearest one), `other`, `distance [m]`, the
/// points `part_x [m]` ... `other_z [m]`, `minima`, `every_minimum` (0 or 1), `overlap` (nameOf, or "touching"),
/// `distance_bound` (0 or 1).
std::string clearanceCsv(const Scene& scene, const std::vector<PartClearance>& clearances);

}  // namespace nearfit
