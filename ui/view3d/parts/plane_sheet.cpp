#include "ui/view3d/parts/plane_sheet.h"

#include <QColor>

#include <vtkCellArray.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/view3d/vtk/pixel_sizes.h"

namespace nearfit::ui {

PlaneSheet::PlaneSheet(vtkRenderer& renderer) : renderer_(&renderer) {
  corners_->SetDataTypeToDouble();
  corners_->SetNumberOfPoints(4);
  const vtkIdType round[] = {0, 1, 2, 3, 0};
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(5, round);
  outline_->SetPoints(corners_);
  outline_->SetLines(lines);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(outline_);
  actor_->SetMapper(mapper);
  actor_->PickableOff();
  actor_->GetProperty()->LightingOff();
  actor_->GetProperty()->SetLineWidth(devicePixels(1.6F));
  actor_->VisibilityOff();
  renderer.AddActor(actor_);
}

PlaneSheet::~PlaneSheet() {
  if (renderer_ != nullptr) renderer_->RemoveActor(actor_);
}

void PlaneSheet::show(const CutPlane& plane, const Aabb& box, const QColor& colour) {
  const auto corners = sheetOf(plane, box);
  for (vtkIdType i = 0; i < 4; ++i) {
    const glm::dvec3& corner = corners[static_cast<std::size_t>(i)];
    corners_->SetPoint(i, corner.x, corner.y, corner.z);
  }
  corners_->Modified();
  outline_->Modified();
  actor_->GetProperty()->SetColor(colour.redF(), colour.greenF(), colour.blueF());
  actor_->VisibilityOn();
}

void PlaneSheet::clear() {
  actor_->VisibilityOff();
}

}  // namespace nearfit::ui
