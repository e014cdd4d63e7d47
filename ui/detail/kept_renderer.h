#pragma once

#include <chrono>
#include <span>

#include <vtkNew.h>
#include <vtkOpenGLFramebufferObject.h>

#include "ui/detail/blending_renderer.h"

namespace nearfit::ui {

/// A renderer that can keep a picture of opaque things, with its depths, and draw everything else over it. It
/// is drawn a little at a time, so that nobody waits for millions of triangles.
class KeptRenderer : public BlendingRenderer {
 public:
  static KeptRenderer* New();
  using Superclass = BlendingRenderer;

  /// Begins anew, with the background alone, as the camera sees it now.
  void beginKeeping();
  /// Adds things in their order until the time is over, at least one.
  /// @return How many it added.
  std::size_t keep(std::span<vtkProp* const> props, std::chrono::microseconds time);
  /// What has been added is what pictures begin with from now on.
  void finishKeeping() { isKept_ = true; }
  void dropKept() { isKept_ = false; }
  bool hasKept() const noexcept { return isKept_; }

  void DeviceRenderOpaqueGeometry(vtkFrameBufferObjectBase* fbo = nullptr) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

 protected:
  KeptRenderer() = default;
  int UpdateGeometry(vtkFrameBufferObjectBase* fbo = nullptr) override;

 private:
  /// @param draw  Draws into what is kept instead of the window.
  template <typename Act>
  void intoKept(bool isErased, const Act& draw);
  void paste();

  vtkNew<vtkOpenGLFramebufferObject> kept_;
  bool isKept_ = false;
};

}  // namespace nearfit::ui
