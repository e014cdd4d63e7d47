#include "ui/view3d/finding_marks.h"

#include <span>

#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/view3d/vtk/pixel_sizes.h"
#include "ui/view3d/vtk/vtk_convert.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Collects cells that share no points.
class FindingCells {
 public:
  FindingCells() { points_->SetDataTypeToDouble(); }

  void add(std::span<const glm::dvec3> corners) {
    cells_->InsertNextCell(static_cast<int>(corners.size()));
    for (const glm::dvec3& p : corners)
      cells_->InsertCellPoint(points_->InsertNextPoint(p.x, p.y, p.z));
  }
  vtkPoints* points() { return points_; }
  vtkCellArray* cells() { return cells_; }

 private:
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> cells_;
};

}  // namespace

FindingMarks::FindingMarks(vtkRenderer& overlay) : overlay_(&overlay) {
  setUp(*face_, *faces_.Get());
  setUp(*line_, *lines_.Get());
  setUp(*point_, *points_.Get());
  constexpr double kFaceOpacity = 0.5;
  face_->GetProperty()->SetOpacity(kFaceOpacity);
  line_->GetProperty()->SetLineWidth(devicePixels(3.5F));
  point_->GetProperty()->SetPointSize(devicePixels(11.0F));
  point_->GetProperty()->RenderPointsAsSpheresOn();
}

FindingMarks::~FindingMarks() {
  for (vtkActor* actor : {face_.Get(), line_.Get(), point_.Get()})
    overlay_->RemoveActor(actor);
}

void FindingMarks::setUp(vtkActor& actor, vtkPolyData& data) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(&data);
  mapper->ScalarVisibilityOff();
  actor.SetMapper(mapper);
  actor.SetUserMatrix(pose_);
  actor.PickableOff();
  actor.VisibilityOff();
  actor.GetProperty()->LightingOff();
  overlay_->AddActor(&actor);
}

void FindingMarks::show(const MeshFinding& finding, const RigidTransform& worldFromPart) {
  FindingCells faces, lines, points;
  for (const TriangleCorners& t : finding.triangles)
    faces.add(t);
  for (const auto& edge : finding.edges)
    lines.add(edge);
  if (finding.hasPlace) points.add(std::span(&finding.point, 1));
  for (vtkPolyData* data : {faces_.Get(), lines_.Get(), points_.Get()})
    data->Initialize();
  faces_->SetPoints(faces.points());
  faces_->SetPolys(faces.cells());
  lines_->SetPoints(lines.points());
  lines_->SetLines(lines.cells());
  points_->SetPoints(points.points());
  points_->SetVerts(points.cells());
  face_->SetVisibility(faces_->GetNumberOfCells() > 0);
  line_->SetVisibility(lines_->GetNumberOfCells() > 0);
  point_->SetVisibility(points_->GetNumberOfCells() > 0);
  const QColor colour = themed(colours::kOverlap);
  for (vtkActor* actor : {face_.Get(), line_.Get(), point_.Get()})
    actor->GetProperty()->SetColor(colour.redF(), colour.greenF(), colour.blueF());
  setPose(worldFromPart);
}

void FindingMarks::setPose(const RigidTransform& worldFromPart) {
  setMatrix(*pose_.Get(), worldFromPart);
}

void FindingMarks::clear() {
  for (vtkActor* actor : {face_.Get(), line_.Get(), point_.Get()})
    actor->VisibilityOff();
}

bool FindingMarks::isShown() const {
  return point_->GetVisibility() != 0;
}

}  // namespace nearfit::ui
