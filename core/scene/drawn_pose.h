#pragma once

#include "core/base/progress.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Where a part was drawn, worldFromPart: where its CAD document places its shape, or the identity for a mesh file, whose
/// coordinates are those of the drawing. Of several places of a shape it is the only one at which no other part of that
/// shape is.
/// Reads the document again, or takes it from the cache. Blocking. Throws UsageError if the part is unknown or has no
/// file, or if several places are free; FileError if the document cannot be read or was changed; Cancelled.
RigidTransform drawnPose(const Scene& scene, PartId id, const ProgressCallback& progress = {});

}  // namespace nearfit
