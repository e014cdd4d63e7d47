#pragma once

namespace nearfit::desktop {

/// Qt and VTK end the process where they find no display or no OpenGL: looked for before they do. Both throw
/// Error with the remedy. The first needs no QApplication, the second does.
void requireDisplay();
void requireOpenGl();

}  // namespace nearfit::desktop
