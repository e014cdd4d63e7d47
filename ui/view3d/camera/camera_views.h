#pragma once

#include <cstdint>
#include <span>

#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkRenderer.h>

#include "core/placing/view_projection.h"

namespace nearfit::ui {

/// Standard directions of view. z is up; Front looks along +y; Top shows x to the right.
enum class StandardView : std::uint8_t { Isometric, Front, Right, Top };

/// Turns the camera to `view` and fits `bounds` into it.
/// @param bounds  World, VTK's order (xmin, xmax, ymin, ...) [m].
void setStandardView(vtkRenderer& renderer, StandardView view, const double bounds[6]);

/// Moves the camera, without turning it, so that `bounds` fill the view but for a small margin.
void fitView(vtkRenderer& renderer, const double bounds[6]);
/// Same for several boxes; fits them tighter than their common bounding box would.
/// @param boxes  At least one, each valid; world [m].
void fitView(vtkRenderer& renderer, std::span<const vtkBoundingBox> boxes);

/// Returns the camera's pose and projection for core; lengths in [m], angles in [rad].
ViewProjection::Camera projectionCamera(vtkCamera& camera);

}  // namespace nearfit::ui
