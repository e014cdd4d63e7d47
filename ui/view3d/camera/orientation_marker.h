#pragma once

class vtkCameraOrientationWidget;
class vtkRenderer;

namespace nearfit::ui {

/// Sets up the axes in the corner of a view, which turn with its camera and turn it when dragged.
/// @param parent  Renderer whose camera they show; must have a window and an interactor.
void setUpOrientationMarker(vtkCameraOrientationWidget& marker, vtkRenderer& parent);

/// Sets the marker's size.
/// @param scale  1: the size in the view; exported pictures use others.
void sizeOrientationMarker(vtkCameraOrientationWidget& marker, double scale);

}  // namespace nearfit::ui
