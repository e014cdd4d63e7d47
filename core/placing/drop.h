#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Options of dropParts().
struct DropOptions {
  /// In the world frame; any length but 0.
  glm::dvec3 direction{0.0, 0.0, -1.0};
  /// Min distance to leave before contact, along the direction [m]; finite, >= 0. 0: dropGap() of
  /// the moved parts.
  double gap = 0.0;
};

/// Result of dropParts().
struct DropResult {
  enum class Outcome {
    Contact,      ///< The parts move by `travel` and stop a gap short of `against`.
    NothingMet,   ///< Nothing is in the way at any distance.
    Overlapping,  ///< `moved` and `against` already meet, touch or contain each other.
  };
  Outcome outcome = Outcome::NothingMet;
  double travel = 0.0;        ///< Along the direction [m].
  double gap = 0.0;           ///< Distance left before contact, along the direction [m].
  glm::dvec3 shift{0.0};      ///< Translation of each part, in the world frame [m].
  glm::dvec3 normal{0.0};     ///< Of the surface hit, against the direction; unit, in the world frame.
  PartId moved{}, against{};  ///< The two parts that meet.
};

/// Default distance left before contact [m]: a micrometre, less for small parts.
/// @param size  Bounding box diagonal of the smallest moved part [m].
double dropGap(double size) noexcept;

/// Moves parts together along a direction, without rotation, until the first of them would touch another
/// visible part: drop to contact.
///
/// The travel is exact up to rounding (straight_contact.h) and free of contact before its end, which is `gap`
/// short of contact along the direction. Exact predicates verify that no two bodies meet at the end, and their distance
/// is verified to be above the deviation of their flats (NormalConeTree::deviation()), so that the part is felt when it is
/// taken in hand; where the gap is too small for that, or rounding is coarser than it, more is left. Parts already
/// within the gap do not move, so dropping again changes nothing.
///
/// A part that is moved by itself goes along what its joints allow of the direction.
///
/// @param moved  Parts of the scene, each once; those without geometry are ignored.
/// Throws UsageError if a part is unknown or locked, an option is invalid, or joints hold the part against the
/// direction; Cancelled. Builds missing
/// hierarchies. Blocking; not real-time safe.
DropResult dropParts(const Scene& scene, std::span<const PartId> moved, const DropOptions& options,
                     const ProgressCallback& progress = {});

}  // namespace nearfit
