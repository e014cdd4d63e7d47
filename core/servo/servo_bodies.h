#pragma once

#include <functional>

#include "core/base/progress.h"
#include "core/servo/servo_scene.h"

namespace nearfit {

/// Adds the visible parts of a scene that stand still as bodies, and what contact with them needs: builds missing
/// hierarchies, of the moving part too, and sets surfaces. To be called last, once the moving part is set. Throws
/// Cancelled.
/// @param isMoved  True for the parts that move.
void addBodies(ServoScene& servo, const Scene& scene, const std::function<bool(PartId)>& isMoved,
               const ProgressCallback& progress = {});

}  // namespace nearfit
