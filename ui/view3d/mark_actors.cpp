#include "ui/view3d/mark_actors.h"

#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/view3d/vtk/pixel_sizes.h"
#include "ui/view3d/vtk/vtk_convert.h"

namespace nearfit::ui {

void MarkCells::add(std::span<const glm::dvec3> corners) {
  cells_->InsertNextCell(static_cast<int>(corners.size()));
  for (const glm::dvec3& p : corners)
    cells_->InsertCellPoint(points_->InsertNextPoint(p.x, p.y, p.z));
}

MarkActors::MarkActors(vtkRenderer& renderer, const Look& look) : renderer_(&renderer) {
  setUp(*face_.Get(), *faces_.Get());
  setUp(*line_.Get(), *lines_.Get());
  setUp(*point_.Get(), *points_.Get());
  face_->GetProperty()->SetOpacity(look.faceOpacity);
  line_->GetProperty()->SetLineWidth(devicePixels(look.lineWidth));
  point_->GetProperty()->SetPointSize(devicePixels(look.pointSize));
  point_->GetProperty()->RenderPointsAsSpheresOn();
}

MarkActors::~MarkActors() {
  for (vtkActor* actor : {face_.Get(), line_.Get(), point_.Get()})
    renderer_->RemoveActor(actor);
}

void MarkActors::setUp(vtkActor& actor, vtkPolyData& data) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(&data);
  mapper->ScalarVisibilityOff();
  actor.SetMapper(mapper);
  actor.SetUserMatrix(pose_);
  actor.PickableOff();
  actor.VisibilityOff();
  actor.GetProperty()->LightingOff();
  renderer_->AddActor(&actor);
}

void MarkActors::showFilled() {
  face_->SetVisibility(faces_->GetNumberOfCells() > 0);
  line_->SetVisibility(lines_->GetNumberOfCells() > 0);
  point_->SetVisibility(points_->GetNumberOfCells() > 0);
}

void MarkActors::show(MarkCells& faces, MarkCells& lines, MarkCells& points) {
  for (vtkPolyData* data : {faces_.Get(), lines_.Get(), points_.Get()})
    data->Initialize();
  faces_->SetPoints(faces.points());
  faces_->SetPolys(faces.cells());
  lines_->SetPoints(lines.points());
  lines_->SetLines(lines.cells());
  points_->SetPoints(points.points());
  points_->SetVerts(points.cells());
  showFilled();
}

void MarkActors::setColours(const QColor& face, const QColor& linesAndPoints) {
  const auto colour = [](vtkActor& actor, const QColor& shown) {
    actor.GetProperty()->SetColor(shown.redF(), shown.greenF(), shown.blueF());
  };
  colour(*face_.Get(), face);
  colour(*line_.Get(), linesAndPoints);
  colour(*point_.Get(), linesAndPoints);
}

void MarkActors::setPose(const RigidTransform& worldFromMark) {
  setMatrix(*pose_.Get(), worldFromMark);
}

void MarkActors::clear() {
  for (vtkActor* actor : {face_.Get(), line_.Get(), point_.Get()})
    actor->VisibilityOff();
}

bool MarkActors::isShown() const {
  return face_->GetVisibility() != 0 || line_->GetVisibility() != 0 || point_->GetVisibility() != 0;
}

}  // namespace nearfit::ui
