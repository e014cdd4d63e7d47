#pragma once

#include <functional>

#include <vtkInteractorStyleTrackballCamera.h>

namespace nearfit::ui {

/// How the mouse moves the camera: VTK's trackball without its letter keys, some of which end the program or
/// switch to stereo. It draws nothing itself: VTK would draw a picture for each event, however many come
/// between two pictures of the display.
class CameraStyle : public vtkInteractorStyleTrackballCamera {
 public:
  static CameraStyle* New();
  using Superclass = vtkInteractorStyleTrackballCamera;

  /// Called when an event has moved the camera.
  void onMoved(std::function<void()> moved) { moved_ = std::move(moved); }

  void OnChar() override {}
  void OnKeyPress() override {}
  void OnMouseMove() override;
  /// With Ctrl it orbits, wherever the pointer is: a left drag may be a tool's.
  void OnMiddleButtonDown() override;
  void OnMiddleButtonUp() override;
  void OnMouseWheelForward() override;
  void OnMouseWheelBackward() override;

 protected:
  CameraStyle() = default;

 private:
  template <typename Act>
  void withoutDrawing(const Act& act);

  std::function<void()> moved_;
};

}  // namespace nearfit::ui
