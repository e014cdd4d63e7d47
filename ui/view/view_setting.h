#pragma once

#include <vtkRenderer.h>

namespace nearfit::ui {

/// Lights that go with the camera.
void setUpLights(vtkRenderer& renderer);
/// The background: light or dark, as the theme is.
void setUpBackground(vtkRenderer& renderer);

}  // namespace nearfit::ui
