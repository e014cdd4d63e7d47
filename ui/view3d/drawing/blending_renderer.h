#pragma once

#include <vtkOpenGLRenderer.h>

namespace nearfit::ui {

/// A renderer that skips VTK's passes for translucent geometry where their order does not matter. In software
/// OpenGL those cost as much as a hundred thousand triangles.
class BlendingRenderer : public vtkOpenGLRenderer {
 public:
  static BlendingRenderer* New();
  using Superclass = vtkOpenGLRenderer;

  /// Set true if translucent things of several colours may overlap: then VTK sorts them. Else each is blended
  /// over what was drawn before, which is right in any order if all have one colour.
  void setManyColoured(bool is) noexcept { isManyColoured_ = is; }

  void DeviceRenderTranslucentPolygonalGeometry(vtkFrameBufferObjectBase* fbo = nullptr) override;

 protected:
  BlendingRenderer() = default;

 private:
  bool isManyColoured_ = false;
};

}  // namespace nearfit::ui
