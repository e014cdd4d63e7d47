#pragma once

#include <vtkBoundingBox.h>
#include <vtkRenderer.h>

namespace nearfit::ui {

/// Sets the depths that the camera sees.
/// @param box   In the world [m]; nothing is done where it is empty.
/// @param room  Around it, in parts of its size.
void fitDepths(vtkRenderer& renderer, vtkBoundingBox box, double room = 0.0);
/// Leaves the depths that the camera sees where the box lies within them, and fits them to it otherwise.
/// @return Whether they stayed.
bool keepDepths(vtkRenderer& renderer, const vtkBoundingBox& box);

}  // namespace nearfit::ui
