#pragma once

namespace nearfit::ui {

/// Converts a line width or point size from device-independent to device pixels, which VTK uses. Goes by the
/// screen with the highest pixel ratio.
float devicePixels(float pixels);

}  // namespace nearfit::ui
