#pragma once

namespace nearfit::desktop {

/// Check for a display and for OpenGL 3.2 before Qt and VTK do, which end the process without them. Throw
/// Error with the remedy. requireDisplay() needs no QApplication; requireOpenGl() does.
void requireDisplay();
void requireOpenGl();

}  // namespace nearfit::desktop
