#pragma once

#include <functional>

#include <vtkInteractorStyleTrackballCamera.h>

namespace nearfit::ui {

/// Camera control by mouse: VTK's trackball without its letter keys, some of which end the program
/// or switch to stereo. Never renders by itself; VTK would render at each event, even several
/// times per display refresh.
class CameraStyle : public vtkInteractorStyleTrackballCamera {
 public:
  static CameraStyle* New();
  using Superclass = vtkInteractorStyleTrackballCamera;

  /// Sets the function called when an event has moved the camera.
  void onMoved(std::function<void()> moved) { moved_ = std::move(moved); }

  void OnChar() override {}
  void OnKeyPress() override {}
  void OnMouseMove() override;
  /// With Ctrl it orbits, wherever the pointer is; a left drag may belong to a tool.
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
