#include "ui/view3d/drawing/caching_renderer.h"

#include <qopengl.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLFXAAFilter.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>

namespace nearfit::ui {

BlendingRenderer* BlendingRenderer::New() {
  VTK_STANDARD_NEW_BODY(BlendingRenderer);
}

void BlendingRenderer::DeviceRenderTranslucentPolygonalGeometry(vtkFrameBufferObjectBase* fbo) {
  if (isManyColoured_) return Superclass::DeviceRenderTranslucentPolygonalGeometry(fbo);
  UpdateTranslucentPolygonalGeometry();
}

CachingRenderer* CachingRenderer::New() {
  VTK_STANDARD_NEW_BODY(CachingRenderer);
}

template <typename Act>
void CachingRenderer::into(vtkOpenGLFramebufferObject& target, int width, int height, bool isErased,
                           const Act& draw) {
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(GetRenderWindow());
  if (window == nullptr) return;
  window->MakeCurrent();
  vtkOpenGLState* state = window->GetState();
  // Others may have changed the OpenGL state meanwhile.
  state->Reset();
  state->Push();
  // Translucent blending leaves depth tests and writes off.
  state->vtkglEnable(GL_DEPTH_TEST);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglDepthFunc(GL_LEQUAL);
  state->PushFramebufferBindings();
  target.SetContext(window);
  if (target.GetFBOIndex() == 0) {
    constexpr int kDepthBits = 32;
    target.PopulateFramebuffer(width, height, true, 1, VTK_UNSIGNED_CHAR, true, kDepthBits, 0);
  }
  target.Bind();
  target.Resize(width, height);
  target.ActivateDrawBuffer(0);
  SetErase(isErased);
  UpdateCamera();
  SetErase(true);
  UpdateLightGeometry();
  UpdateLights();
  draw();
  window->WaitForCompletion();
  state->PopFramebufferBindings();
  state->Pop();
}

template <typename Act>
void CachingRenderer::intoKept(bool isErased, const Act& draw) {
  vtkRenderWindow* window = GetRenderWindow();
  if (window == nullptr) return;
  const int* size = window->GetSize();
  into(*kept_.Get(), size[0], size[1], isErased, draw);
}

void CachingRenderer::beginKeeping() {
  isKept_ = false;
  intoKept(true, [] {});
}

std::size_t CachingRenderer::keep(std::span<vtkProp* const> props, std::chrono::microseconds time) {
  using Clock = std::chrono::steady_clock;
  std::size_t count = 0;
  intoKept(false, [&] {
    const Clock::time_point end = Clock::now() + time;
    while (count < props.size() && (count == 0 || Clock::now() < end))
      props[count++]->RenderOpaqueGeometry(this);
  });
  return count;
}

void CachingRenderer::prepare(const std::function<std::vector<vtkProp*>()>& next,
                              std::chrono::microseconds time) {
  using Clock = std::chrono::steady_clock;
  // One pixel takes all that uploading needs, and costs no filling.
  into(*unseen_.Get(), 1, 1, false, [&] {
    const Clock::time_point end = Clock::now() + time;
    do {
      const std::vector<vtkProp*> props = next();
      if (props.empty()) return;
      for (vtkProp* prop : props) {
        // Each draws only what is of its kind.
        prop->RenderOpaqueGeometry(this);
        prop->RenderTranslucentPolygonalGeometry(this);
      }
    } while (Clock::now() < end);
  });
}

void CachingRenderer::paste() {
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(GetRenderWindow());
  vtkOpenGLState* state = window->GetState();
  const int* size = kept_->GetLastSize();
  state->PushReadFramebufferBinding();
  kept_->Bind(GL_READ_FRAMEBUFFER);
  kept_->ActivateReadBuffer(0);
  state->vtkglBlitFramebuffer(0, 0, size[0], size[1], 0, 0, size[0], size[1], GL_COLOR_BUFFER_BIT,
                              GL_NEAREST);
  state->PopReadFramebufferBinding();
  // OpenGL blits depths only between equal formats, and VTK chooses the window's.
  window->TextureDepthBlit(kept_->GetDepthAttachmentAsTextureObject(), 0, 0, size[0] - 1, size[1] - 1, 0, 0,
                           size[0] - 1, size[1] - 1);
}

void CachingRenderer::DeviceRenderOpaqueGeometry(vtkFrameBufferObjectBase* fbo) {
  if (isKept_) paste();
  Superclass::DeviceRenderOpaqueGeometry(fbo);
}

int CachingRenderer::UpdateGeometry(vtkFrameBufferObjectBase* fbo) {
  if (!isKept_ || PropArrayCount > 0) return Superclass::UpdateGeometry(fbo);
  // VTK's version draws nothing if there are no other props.
  paste();
  if (!UseFXAA) return 0;
  if (FXAAFilter == nullptr) FXAAFilter = vtkOpenGLFXAAFilter::New();
  FXAAFilter->Execute(this);
  return 0;
}

void CachingRenderer::ReleaseGraphicsResources(vtkWindow* window) {
  isKept_ = false;
  kept_->ReleaseGraphicsResources(window);
  unseen_->ReleaseGraphicsResources(window);
  Superclass::ReleaseGraphicsResources(window);
}

}  // namespace nearfit::ui
