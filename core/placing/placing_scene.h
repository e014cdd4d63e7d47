#pragma once

#include <memory>
#include <span>

#include "core/base/progress.h"
#include "core/scene/scene.h"
#include "core/servo/servo_scene.h"

namespace nearfit {

/// Builds a servo scene in which some parts, as one rigid body, are the moving part among all other visible
/// parts. A single part stays as it is, in its own frame; several become one mesh, in the frame of the first.
/// Invisible parts are left out; if no moved part remains, nothing can be touched. Builds missing
/// hierarchies, which takes seconds for millions of triangles (prepareHierarchies() can do so beforehand).
/// @param moved  Not empty.
/// Throws UsageError if a part is not in the scene; Cancelled.
std::shared_ptr<const ServoScene> makePlacingScene(const Scene& scene, std::span<const PartId> moved,
                                                   const ProgressCallback& progress = {});

}  // namespace nearfit
