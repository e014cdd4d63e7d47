#pragma once

#include <vtkRenderer.h>

namespace nearfit::ui {

/// Adds lights that move with the camera.
void setUpLights(vtkRenderer& renderer);
/// Sets the background, light or dark as the theme is.
void setUpBackground(vtkRenderer& renderer);

}  // namespace nearfit::ui
