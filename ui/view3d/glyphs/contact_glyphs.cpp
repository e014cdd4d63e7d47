#include "ui/view3d/glyphs/contact_glyphs.h"

#include <algorithm>

#include <vtkArrowSource.h>
#include <vtkCylinderSource.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkProperty.h>
#include <vtkSmartPointer.h>
#include <vtkTransform.h>
#include <vtkTransformPolyDataFilter.h>

#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kDiscSides = 28;
/// Fractions of the part's size: disc radii, and arrow lengths at zero and at the device's max force.
constexpr double kDiscRadius = 0.026, kRimRadius = 0.033, kShortest = 0.11, kLongest = 0.45;
constexpr const char *kDirection = "direction", *kDisc = "disc", *kArrow = "arrow";

/// Returns a flat cylinder around the x axis.
vtkSmartPointer<vtkTransformPolyDataFilter> discAcrossX(double radius, double height) {
  vtkNew<vtkCylinderSource> cylinder;
  cylinder->SetRadius(radius);
  cylinder->SetHeight(height);
  cylinder->SetResolution(kDiscSides);
  vtkNew<vtkTransform> turn;
  turn->RotateZ(90.0);
  auto disc = vtkSmartPointer<vtkTransformPolyDataFilter>::New();
  disc->SetInputConnection(cylinder->GetOutputPort());
  disc->SetTransform(turn);
  return disc;
}

/// Draws `shape` at the points, oriented along their directions: one draw call, no geometry rebuilt.
void setUp(vtkActor& actor, vtkPolyData& points, vtkAlgorithmOutput* shape, const char* scale,
           const QColor& colour) {
  vtkNew<vtkGlyph3DMapper> mapper;
  mapper->SetInputData(&points);
  mapper->SetSourceConnection(shape);
  mapper->SetOrientationArray(kDirection);
  mapper->SetOrientationModeToDirection();
  mapper->SetScaleArray(scale);
  mapper->SetScaleModeToScaleByMagnitude();
  mapper->ScalarVisibilityOff();
  actor.SetMapper(mapper);
  actor.PickableOff();
  vtkProperty* property = actor.GetProperty();
  property->SetColor(colour.redF(), colour.greenF(), colour.blueF());
  property->SetAmbient(0.4);
  property->SetDiffuse(0.65);
}

vtkSmartPointer<vtkDoubleArray> namedArray(const char* name, int components) {
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  return array;
}

}  // namespace

ContactGlyphs::ContactGlyphs(vtkRenderer& renderer) {
  show({}, 1.0);
  setUp(*rims_, *points_.Get(), discAcrossX(kRimRadius / kDiscRadius, 0.14)->GetOutputPort(), kDisc,
        Qt::white);
  setUp(*discs_, *points_.Get(), discAcrossX(1.0, 0.24)->GetOutputPort(), kDisc, colours::kContact);
  vtkNew<vtkArrowSource> arrow;
  arrow->SetTipLength(0.34);
  arrow->SetTipRadius(0.1);
  arrow->SetShaftRadius(0.035);
  arrow->SetTipResolution(kDiscSides);
  arrow->SetShaftResolution(kDiscSides);
  setUp(*arrows_, *points_.Get(), arrow->GetOutputPort(), kArrow, colours::kContact);
  for (vtkActor* actor : {rims_.Get(), discs_.Get(), arrows_.Get()})
    renderer.AddActor(actor);
  applyVisibility();
}

void ContactGlyphs::show(std::span<const SnapshotContact> contacts, double size) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const auto directions = namedArray(kDirection, 3), discs = namedArray(kDisc, 1),
             arrows = namedArray(kArrow, 1);
  for (const SnapshotContact& contact : contacts) {
    points->InsertNextPoint(contact.point.x, contact.point.y, contact.point.z);
    directions->InsertNextTuple3(contact.direction.x, contact.direction.y, contact.direction.z);
    discs->InsertNextValue(kDiscRadius * size);
    const double share = std::clamp(contact.force / DeviceLimits{}.maxForce, 0.0, 1.0);
    arrows->InsertNextValue((kShortest + share * (kLongest - kShortest)) * size);
  }
  points_->SetPoints(points);
  for (vtkDoubleArray* array : {directions.Get(), discs.Get(), arrows.Get()})
    points_->GetPointData()->AddArray(array);
  hasContacts_ = !contacts.empty();
  applyVisibility();
}

void ContactGlyphs::setVisible(bool isVisible) {
  isVisible_ = isVisible;
  applyVisibility();
}

void ContactGlyphs::setOpacity(double share) {
  for (vtkActor* actor : {rims_.Get(), discs_.Get(), arrows_.Get()})
    actor->GetProperty()->SetOpacity(share);
}

void ContactGlyphs::applyVisibility() {
  for (vtkActor* actor : {rims_.Get(), discs_.Get(), arrows_.Get()})
    actor->SetVisibility(isVisible_ && hasContacts_);
}

}  // namespace nearfit::ui
