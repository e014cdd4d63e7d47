#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "core/scene/scene.h"

namespace nearfit {

struct DropOptions {
  /// In the world; of any length but 0.
  glm::dvec3 direction{0.0, 0.0, -1.0};
  /// Left of the way before contact [m]; finite, > 0. 0: dropGap() of the parts that move.
  double gap = 0.0;
};

struct DropResult {
  enum class Outcome {
    Contact,      ///< The parts go `travel` far, and stop a gap before they touch `against`.
    NothingMet,   ///< Nothing is in the way, however far they go.
    Overlapping,  ///< `moved` and `against` meet, touch or contain each other at the start.
  };
  Outcome outcome = Outcome::NothingMet;
  double travel = 0.0;        ///< [m]
  double gap = 0.0;           ///< What is left of the way at the end [m].
  glm::dvec3 shift{0.0};      ///< Of each part, in the world [m].
  glm::dvec3 normal{0.0};     ///< Of the surface that is met, against the direction, unit, in the world.
  PartId moved{}, against{};  ///< Which parts meet.
};

/// What is left before contact where nothing else is asked for: a micrometre, for small parts less [m].
/// @param size  Of the smallest part that moves [m].
double dropGap(double size) noexcept;

/// Moves parts together straight along a direction, without turning, to where the first of them would touch a
/// part that does not move: the drop to contact. Only visible parts are in the way.
///
/// The travel is exact but for rounding (straight_contact.h): the way before it is free, and it ends `gap`
/// short of contact, measured along the way. That no two bodies meet at the end is decided by exact
/// predicates; where rounding is coarser than the gap, more is left. Parts that stand nearer than the gap
/// before each other already do not move at all: those that were dropped stay where they are when they are
/// dropped again.
///
/// @param moved  Of the scene, each once; those without geometry do not count.
/// Throws UsageError when a part is unknown or locked, or a number makes no sense; Cancelled. Builds
/// hierarchies that are missing. Not real-time safe.
DropResult dropParts(const Scene& scene, std::span<const PartId> moved, const DropOptions& options,
                     const ProgressCallback& progress = {});

}  // namespace nearfit
