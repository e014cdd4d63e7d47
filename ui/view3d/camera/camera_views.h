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

/// Changes to orthographic (parallel) projection or back to perspective. What lies at the focal point keeps its
/// size and place.
void setOrthographic(vtkCamera& camera, bool isOrthographic);

/// Moves the camera, without turning it, so that `bounds` fill the view but for a small margin.
void fitView(vtkRenderer& renderer, const double bounds[6]);
/// Same for several boxes; fits them tighter than their common bounding box would.
/// @param boxes  At least one, each valid; world [m].
void fitView(vtkRenderer& renderer, std::span<const vtkBoundingBox> boxes);

/// Returns the camera's pose and projection for core; lengths in [m], angles in [rad].
ViewProjection::Camera projectionCamera(vtkCamera& camera);

/// Fits the camera's clipping range to a box. In orthographic projection it also moves the eye back where the
/// box is not in front of it: what is seen stays the same, and nothing is clipped.
/// @param box   World [m]; nothing happens if it is empty.
/// @param room  Margin around the box, as a fraction of its longest side.
void fitDepths(vtkRenderer& renderer, vtkBoundingBox box, double room = 0.0);
/// Keeps the clipping range if the box lies within it; else fits it to the box, as fitDepths() does.
/// @return  True if it was kept.
bool keepDepths(vtkRenderer& renderer, const vtkBoundingBox& box);

/// Adds lights that move with the camera.
void setUpLights(vtkRenderer& renderer);
/// Sets the background, light or dark as the theme is.
void setUpBackground(vtkRenderer& renderer);

}  // namespace nearfit::ui
