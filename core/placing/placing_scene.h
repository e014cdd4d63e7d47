#pragma once

#include <memory>
#include <span>

#include "core/haptics/servo_scene.h"
#include "core/progress.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Parts of a scene as one rigid body in hand, among all visible others. Of one part that is itself, in its
/// own frame; several become one mesh, in the frame of the first. Those that are invisible are left out;
/// where none is left, nothing can be met. Builds the hierarchies that are missing, which takes seconds for
/// millions of triangles (prepareHierarchies() does so before).
/// @param moved  Not empty.
/// Throws UsageError when a part is not in the scene, and Cancelled.
std::shared_ptr<const ServoScene> makePlacingScene(const Scene& scene, std::span<const PartId> moved,
                                                   const ProgressCallback& progress = {});

}  // namespace nearfit
