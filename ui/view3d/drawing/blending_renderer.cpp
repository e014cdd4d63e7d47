#include "ui/view3d/drawing/blending_renderer.h"

#include <vtkObjectFactory.h>

namespace nearfit::ui {

BlendingRenderer* BlendingRenderer::New() {
  VTK_STANDARD_NEW_BODY(BlendingRenderer);
}

void BlendingRenderer::DeviceRenderTranslucentPolygonalGeometry(vtkFrameBufferObjectBase* fbo) {
  if (isManyColoured_) return Superclass::DeviceRenderTranslucentPolygonalGeometry(fbo);
  UpdateTranslucentPolygonalGeometry();
}

}  // namespace nearfit::ui
