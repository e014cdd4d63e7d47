#pragma once

class vtkCameraOrientationWidget;
class vtkRenderer;

namespace nearfit::ui {

/// The axes in the corner of a view, which turn with it and turn it.
///
/// @param parent  Whose camera they show; it has a window and an interactor.
void setUpOrientationMarker(vtkCameraOrientationWidget& marker, vtkRenderer& parent);

/// @param scale  1: as large as the view shows them; pictures of the view have others.
void sizeOrientationMarker(vtkCameraOrientationWidget& marker, double scale);

}  // namespace nearfit::ui
