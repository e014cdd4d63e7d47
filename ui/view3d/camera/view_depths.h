#pragma once

#include <vtkBoundingBox.h>
#include <vtkRenderer.h>

namespace nearfit::ui {

/// Fits the camera's clipping range to a box.
/// @param box   World [m]; nothing happens if it is empty.
/// @param room  Margin around the box, as a fraction of its longest side.
void fitDepths(vtkRenderer& renderer, vtkBoundingBox box, double room = 0.0);
/// Keeps the clipping range if the box lies within it; else fits it to the box.
/// @return  True if it was kept.
bool keepDepths(vtkRenderer& renderer, const vtkBoundingBox& box);

}  // namespace nearfit::ui
