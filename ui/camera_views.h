#pragma once

#include <cstdint>
#include <span>

#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkRenderer.h>

#include "core/placing/view_projection.h"

namespace nearfit::ui {

/// Directions to look from; z is up, front looks along +y, top shows x to the right.
enum class StandardView : std::uint8_t { Isometric, Front, Right, Top };

/// Turns the camera to look from there at the bounds (VTK's order) and fits them into the view.
void setStandardView(vtkRenderer& renderer, StandardView view, const double bounds[6]);

/// Moves the camera, without turning it, so that the bounds just fill the view with a margin around them.
void fitView(vtkRenderer& renderer, const double bounds[6]);
/// The same for several boxes, which fill the view more than the one around them all. @param boxes  At least
/// one, valid.
void fitView(vtkRenderer& renderer, std::span<const vtkBoundingBox> boxes);

/// What the camera sees, for core.
ViewProjection::Camera projectionCamera(vtkCamera& camera);

}  // namespace nearfit::ui
