#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "core/scene/scene.h"

namespace nearfit {

struct PushResult {
  enum class Outcome {
    Held,         ///< The parts are where what they touch lets them go no farther that way.
    NothingMet,   ///< Nothing is in the way.
    SlippedPast,  ///< They touched, slid along, and past everything, or on and on: nothing holds them.
    Overlapping,  ///< `against` meets them at the start.
  };
  Outcome outcome = Outcome::NothingMet;
  std::vector<RigidTransform>
      poses;  ///< worldFromPart of each, in the order given; the present ones unless held.
  /// What they touch in the end, or meet at the start; first what bars the direction, the nearest before.
  std::vector<PartId> against;
};

/// Pushes parts together along a direction until they are held: straight to the first contact, as dropParts()
/// does, and from there on along what they touch, as SolidMove does, without turning, a margin of the proxy
/// away. Where a drop stops at the first touch, a push slides a ball down a slope into its seat.
///
/// @param moved      As for dropParts().
/// @param direction  In the world; of any length but 0.
/// Throws what dropParts() and SolidMove do. Not real-time safe; may take seconds.
PushResult pushParts(const Scene& scene, std::span<const PartId> moved, const glm::dvec3& direction,
                     const ProgressCallback& progress = {});

}  // namespace nearfit
