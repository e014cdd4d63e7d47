#pragma once

#include <vtkOpenGLRenderer.h>

namespace nearfit::ui {

/// A renderer that spares itself VTK's passes for what shines through, which cost as much as a hundred
/// thousand triangles in software, wherever the order of it does not matter.
class BlendingRenderer : public vtkOpenGLRenderer {
 public:
  static BlendingRenderer* New();
  using Superclass = vtkOpenGLRenderer;

  /// Whether things of several colours shine through one another. Else each is blended over what was there
  /// before, which is as right, in whatever order, where they all have one colour.
  void setManyColoured(bool is) noexcept { isManyColoured_ = is; }

  void DeviceRenderTranslucentPolygonalGeometry(vtkFrameBufferObjectBase* fbo = nullptr) override;

 protected:
  BlendingRenderer() = default;

 private:
  bool isManyColoured_ = false;
};

}  // namespace nearfit::ui
