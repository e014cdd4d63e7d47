#pragma once

namespace nearfit::ui {

/// Widths of lines and sizes of points for VTK, which counts the screen's own pixels: from sizes as they are
/// on a screen of scale 1. Of several screens the finest decides.
float devicePixels(float pixels);

}  // namespace nearfit::ui
