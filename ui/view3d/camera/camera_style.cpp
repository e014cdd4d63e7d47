#include "ui/view3d/camera/camera_style.h"

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

namespace nearfit::ui {

CameraStyle* CameraStyle::New() {
  VTK_STANDARD_NEW_BODY(CameraStyle);
}

template <typename Act>
void CameraStyle::withoutDrawing(const Act& act) {
  vtkRenderWindowInteractor* interactor = GetInteractor();
  interactor->EnableRenderOff();
  vtkCamera* camera = GetDefaultRenderer()->GetActiveCamera();
  const vtkMTimeType before = camera->GetMTime();
  act();
  const bool hasMoved = camera->GetMTime() != before;
  interactor->EnableRenderOn();
  if (hasMoved && moved_) moved_();
}

void CameraStyle::OnMouseMove() {
  withoutDrawing([this] { Superclass::OnMouseMove(); });
}

void CameraStyle::OnMiddleButtonDown() {
  if (GetInteractor()->GetControlKey() == 0) return Superclass::OnMiddleButtonDown();
  FindPokedRenderer(GetInteractor()->GetEventPosition()[0], GetInteractor()->GetEventPosition()[1]);
  GrabFocus(EventCallbackCommand);
  StartRotate();
}

void CameraStyle::OnMiddleButtonUp() {
  if (GetState() == VTKIS_ROTATE) {
    EndRotate();
    if (GetInteractor() != nullptr) ReleaseFocus();
    return;
  }
  Superclass::OnMiddleButtonUp();
}

void CameraStyle::OnMouseWheelForward() {
  withoutDrawing([this] { Superclass::OnMouseWheelForward(); });
}

void CameraStyle::OnMouseWheelBackward() {
  withoutDrawing([this] { Superclass::OnMouseWheelBackward(); });
}

}  // namespace nearfit::ui
