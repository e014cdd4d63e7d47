#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/haptics/servo_snapshot.h"
#include "core/progress.h"
#include "core/proximity/interference.h"
#include "core/scene/scene.h"

namespace nearfit {

/// How near one part is to another. World frame.
struct PartClearance {
  PartId other{};
  /// Least distance between the surfaces, however far [m]; 0 where the parts overlap or touch.
  double distance = 0.0;
  /// Where the surfaces are nearest [m]: points of the part that was asked for, and of the other. Where one
  /// lies inside the other they are of the surfaces too.
  glm::dvec3 partPoint{0.0}, otherPoint{0.0};
  std::size_t minima = 0;      ///< Local minimum distances within the cutoff; 0 where the parts overlap.
  bool isEveryMinimum = true;  ///< False where there are more minima than the search holds.
  /// Decided exactly (interference.h); `scene` there is the other part.
  InterferenceKind overlap = InterferenceKind::Disjoint;
  /// Both are solid throughout: then the least local minimum distance is the least distance.
  bool isBetweenSolids = false;

  bool isOverlapping() const noexcept { return overlap != InterferenceKind::Disjoint; }
};

/// Clearances of a part against each other visible one, in the scene's order. An empty mesh has none.
/// @param cutoff  For the number of minima [m]; > 0.
/// Blocking (milliseconds a pair; hierarchies that are missing are built): not for the GUI's thread. Throws
/// UsageError when there is no such part; Cancelled, between two pairs.
std::vector<PartClearance> clearancesOf(const Scene& scene, PartId part, double cutoff,
                                        const ProgressCallback& progress = {});

/// Brings clearances of the moving part up to date where a tick of the servo knows: pairs of solids within
/// its cutoff. Others, and what overlaps, stay as they are. At once: for the GUI's thread.
void updateFrom(const ServoSnapshot& snapshot, std::vector<PartClearance>& clearances) noexcept;

/// "no", "surfaces meet", "inside the other" or "the other inside".
const char* nameOf(InterferenceKind overlap) noexcept;

/// The same as CSV (UTF-8): `part`, `other`, `distance` [m], the points `part_x ... other_z` [m], `minima`,
/// `every_minimum` (0 or 1), `overlap` as nameOf has it. One row a clearance.
std::string clearanceCsv(const Scene& scene, PartId part, const std::vector<PartClearance>& clearances);

}  // namespace nearfit
