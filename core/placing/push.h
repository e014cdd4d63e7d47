#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Result of pushParts().
struct PushResult {
  enum class Outcome {
    Held,         ///< What the parts touch stops them in that direction.
    NothingMet,   ///< Nothing is in the way.
    SlippedPast,  ///< They touched something but slid past everything, or kept sliding: nothing holds them.
    Overlapping,  ///< `against` meets them at the start.
  };
  Outcome outcome = Outcome::NothingMet;
  /// worldFromPart of each part, in the order given; the present poses unless Held.
  std::vector<RigidTransform> poses;
  /// Parts touched at the end, or met at the start. Those that block the direction come first, nearest first.
  std::vector<PartId> against;
};

/// Pushes parts together along a direction until they are held. They go straight to the first contact, like
/// dropParts(), and then slide along what they touch, like SolidMove: without rotation, a proxy's margin
/// away, and on the joints of a part that is moved by itself. A drop stops at the first touch; a push slides a ball
/// down a slope into its seat.
///
/// @param moved      As for dropParts().
/// @param direction  In the world frame; any length but 0.
/// Throws what dropParts() and SolidMove throw. May take seconds; not real-time safe.
PushResult pushParts(const Scene& scene, std::span<const PartId> moved, const glm::dvec3& direction,
                     const ProgressCallback& progress = {});

}  // namespace nearfit
