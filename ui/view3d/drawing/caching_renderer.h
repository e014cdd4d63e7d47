#pragma once

#include <chrono>
#include <functional>
#include <span>
#include <vector>

#include <vtkNew.h>
#include <vtkOpenGLFramebufferObject.h>
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

/// A renderer that can keep a picture of opaque props with its depth buffer, and draw everything else over
/// it. The kept picture is drawn a little at a time, so that millions of triangles do not block events.
class CachingRenderer : public BlendingRenderer {
 public:
  static CachingRenderer* New();
  using Superclass = BlendingRenderer;

  /// Starts a new kept picture: the background alone, as the camera sees it now.
  void beginKeeping();
  /// Draws props into the kept picture, in order, until `time` is over; at least one.
  /// @return  The number of props drawn.
  std::size_t keep(std::span<vtkProp* const> props, std::chrono::microseconds time);
  /// From now on, pictures start from the kept picture.
  void finishKeeping() { isKept_ = true; }
  /// From now on, pictures draw everything again.
  void dropKept() { isKept_ = false; }
  bool hasKept() const noexcept { return isKept_; }
  /// Draws props where nobody sees it, visible or not: then OpenGL has their geometry and shaders, and pictures that
  /// show them are quick. Draws one set after the other until `time` is over; at least one.
  /// @param next  Returns the next set; empty: there are no more. Called only when its set is drawn.
  void prepare(const std::function<std::vector<vtkProp*>()>& next, std::chrono::microseconds time);

  void DeviceRenderOpaqueGeometry(vtkFrameBufferObjectBase* fbo = nullptr) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

 protected:
  CachingRenderer() = default;
  int UpdateGeometry(vtkFrameBufferObjectBase* fbo = nullptr) override;

 private:
  /// @param width, height  Size of `target` [pixels].
  /// @param draw           Draws into `target` instead of the window.
  template <typename Act>
  void into(vtkOpenGLFramebufferObject& target, int width, int height, bool isErased, const Act& draw);
  /// The same into the kept picture.
  template <typename Act>
  void intoKept(bool isErased, const Act& draw);
  void paste();

  vtkNew<vtkOpenGLFramebufferObject> kept_, unseen_;
  bool isKept_ = false;
};

}  // namespace nearfit::ui
