#include "ui/view3d/vtk/pixel_sizes.h"

#include <QGuiApplication>

namespace nearfit::ui {

float devicePixels(float pixels) {
  return qGuiApp != nullptr ? pixels * static_cast<float>(qGuiApp->devicePixelRatio()) : pixels;
}

}  // namespace nearfit::ui
