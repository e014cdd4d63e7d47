#include "app/desktop/display_check.h"

#include <QOpenGLContext>
#include <QtGlobal>

#include "core/base/error.h"

namespace nearfit::desktop {

void requireDisplay() {
  if (!qEnvironmentVariableIsEmpty("DISPLAY") || !qEnvironmentVariableIsEmpty("WAYLAND_DISPLAY") ||
      !qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM")) {
    return;
  }
  throw Error("", "there is no display", "set DISPLAY, or use nearfit-cli, which needs none");
}

void requireOpenGl() {
  QOpenGLContext context;
  const bool isUsable = context.create() && context.format().version() >= qMakePair(3, 2);
  if (!isUsable) {
    throw Error("", "this display does not support OpenGL 3.2",
                "install a graphics driver, or Mesa's software one (libgl1-mesa-dri)");
  }
}

}  // namespace nearfit::desktop
