#include "ui/view3d/camera/orientation_marker.h"

#include <cmath>

#include <vtkActor.h>
#include <vtkCameraOrientationRepresentation.h>
#include <vtkCameraOrientationWidget.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkEllipticalButtonSource.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPropCollection.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>
#include <vtkTubeFilter.h>

#include "ui/view3d/vtk/pixel_sizes.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr float kPixels = 100.0F, kPadding = 10.0F;  ///< Size; distance from the view's corner.
/// Font size of labels. VTK renders them for each picture, by default ten times as tall as they appear.
constexpr int kFontSize = 36;
/// Segments of a handle's rim, and rings inside it, which all have one colour. VTK's defaults make 15,000
/// triangles for each picture.
constexpr int kHandleSides = 32, kRings = 1;

void coarsen(vtkActor& actor) {
  if (actor.GetMapper() == nullptr) return;
  auto* handle = vtkEllipticalButtonSource::SafeDownCast(actor.GetMapper()->GetInputAlgorithm());
  if (handle == nullptr) return;
  handle->SetCircumferentialResolution(kHandleSides);
  handle->SetShoulderResolution(kRings);
  handle->SetTextureResolution(kRings);
}

/// Gives the axes the colours of gizmo and bars; VTK's differ for y and z. Balls take the background colour
/// of their labels, rods the cell colours of the lines inside their tubes.
void colour(vtkCameraOrientationRepresentation& shape, vtkPropCollection& props) {
  vtkTextProperty* labels[3][2] = {{shape.GetXPlusLabelProperty(), shape.GetXMinusLabelProperty()},
                                   {shape.GetYPlusLabelProperty(), shape.GetYMinusLabelProperty()},
                                   {shape.GetZPlusLabelProperty(), shape.GetZMinusLabelProperty()}};
  for (int axis = 0; axis < 3; ++axis) {
    const QColor colour = axisColour(axis);
    for (vtkTextProperty* label : labels[axis])
      label->SetBackgroundColor(colour.redF(), colour.greenF(), colour.blueF());
  }
  vtkCollectionSimpleIterator it;
  props.InitTraversal(it);
  while (vtkProp* prop = props.GetNextProp(it)) {
    auto* actor = vtkActor::SafeDownCast(prop);
    if (actor == nullptr || actor->GetMapper() == nullptr) continue;
    auto* tubes = vtkTubeFilter::SafeDownCast(actor->GetMapper()->GetInputAlgorithm());
    auto* lines = tubes != nullptr ? vtkPolyData::SafeDownCast(tubes->GetInput()) : nullptr;
    vtkDataArray* colours = lines != nullptr ? lines->GetCellData()->GetScalars() : nullptr;
    if (colours == nullptr || colours->GetNumberOfTuples() != 3) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const QColor colour = axisColour(axis);
      colours->SetTuple3(axis, colour.redF(), colour.greenF(), colour.blueF());
    }
    colours->Modified();
  }
}

}  // namespace

void setUpOrientationMarker(vtkCameraOrientationWidget& marker, vtkRenderer& parent) {
  marker.SetParentRenderer(&parent);
  auto* shape = vtkCameraOrientationRepresentation::SafeDownCast(marker.GetRepresentation());
  for (vtkTextProperty* label :
       {shape->GetXPlusLabelProperty(), shape->GetYPlusLabelProperty(), shape->GetZPlusLabelProperty(),
        shape->GetXMinusLabelProperty(), shape->GetYMinusLabelProperty(), shape->GetZMinusLabelProperty()})
    label->SetFontSize(kFontSize);
  vtkNew<vtkPropCollection> props;
  shape->GetActors(props);
  vtkCollectionSimpleIterator it;
  props->InitTraversal(it);
  while (vtkProp* prop = props->GetNextProp(it)) {
    if (auto* actor = vtkActor::SafeDownCast(prop)) coarsen(*actor);
  }
  colour(*shape, *props);
  sizeOrientationMarker(marker, 1.0);
  marker.On();
}

void sizeOrientationMarker(vtkCameraOrientationWidget& marker, double scale) {
  const auto scaled = [scale](float pixels) {
    return static_cast<int>(std::lround(devicePixels(pixels) * scale));
  };
  auto* shape = vtkCameraOrientationRepresentation::SafeDownCast(marker.GetRepresentation());
  shape->SetSize(scaled(kPixels), scaled(kPixels));
  shape->SetPadding(scaled(kPadding), scaled(kPadding));
}

}  // namespace nearfit::ui
