#include "ui/view3d/joint_marks.h"

#include <initializer_list>

#include <glm/geometric.hpp>
#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "core/math/axes_across.h"
#include "ui/view3d/vtk/pixel_sizes.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Periods of a dash-dotted line, and where in each the dash and the dot begin and end.
constexpr int kPeriods = 14;
constexpr double kDashBegin = 0.0, kDashEnd = 0.6, kDotBegin = 0.75, kDotEnd = 0.85;
constexpr double kFaceOpacity = 0.2;

/// Collects cells of a mark with points of their own.
class MarkCells {
 public:
  MarkCells() { points_->SetDataTypeToDouble(); }

  void add(std::initializer_list<glm::dvec3> corners) {
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

void addDashDotted(MarkCells& lines, const glm::dvec3& from, const glm::dvec3& to) {
  // The last period ends with its dash, so that the line looks the same from both ends.
  const double whole = kPeriods - 1 + kDashEnd;
  const auto at = [&](double period) { return from + (period / whole) * (to - from); };
  for (int i = 0; i < kPeriods; ++i) {
    lines.add({at(i + kDashBegin), at(i + kDashEnd)});
    if (i + 1 < kPeriods) lines.add({at(i + kDotBegin), at(i + kDotEnd)});
  }
}

void addSquare(MarkCells& faces, MarkCells& lines, const JointMark& mark) {
  const std::array<glm::dvec3, 2> across = axesAcross(mark.direction);
  const glm::dvec3 u = mark.reach * across[0], v = mark.reach * across[1];
  const glm::dvec3 a = mark.middle - u - v, b = mark.middle + u - v, c = mark.middle + u + v,
                   d = mark.middle - u + v;
  faces.add({a, b, c, d});
  lines.add({a, b, c, d, a});
}

void addCross(MarkCells& lines, const JointMark& mark) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 reach(0.0);
    reach[axis] = mark.reach;
    lines.add({mark.middle - reach, mark.middle + reach});
  }
}

void addMark(MarkCells& faces, MarkCells& lines, MarkCells& points, const JointMark& mark) {
  const glm::dvec3 reach = mark.reach * mark.direction;
  switch (mark.kind) {
    case JointKind::OnAxis:
      addDashDotted(lines, mark.middle - reach, mark.middle + reach);
      break;
    case JointKind::InPlane:
      addSquare(faces, lines, mark);
      break;
    case JointKind::ToPoint:
      addCross(lines, mark);
      points.add({mark.middle});
      break;
  }
  if (!mark.strayed) return;
  lines.add({mark.middle, *mark.strayed});
  points.add({*mark.strayed});
}

}  // namespace

JointMarks::JointMarks(vtkRenderer& renderer) : renderer_(&renderer) {
  setUp(kept_);
  setUp(strayed_);
}

JointMarks::~JointMarks() {
  for (const Layer* layer : {&kept_, &strayed_}) {
    for (vtkActor* actor : layer->actors())
      renderer_->RemoveActor(actor);
  }
}

void JointMarks::setUp(const Layer& layer) {
  const std::array<vtkPolyData*, 3> data{layer.faces.Get(), layer.lines.Get(), layer.points.Get()};
  for (std::size_t i = 0; i < data.size(); ++i) {
    vtkActor& actor = *layer.actors()[i];
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data[i]);
    mapper->ScalarVisibilityOff();
    actor.SetMapper(mapper);
    actor.PickableOff();
    actor.VisibilityOff();
    actor.GetProperty()->LightingOff();
    renderer_->AddActor(&actor);
  }
  layer.face->GetProperty()->SetOpacity(kFaceOpacity);
  layer.line->GetProperty()->SetLineWidth(devicePixels(2.0F));
  layer.point->GetProperty()->SetPointSize(devicePixels(9.0F));
  layer.point->GetProperty()->RenderPointsAsSpheresOn();
}

void JointMarks::show(const std::vector<JointMark>& marks) {
  std::vector<const JointMark*> kept, strayed;
  for (const JointMark& mark : marks)
    (mark.strayed ? strayed : kept).push_back(&mark);
  fill(kept_, kept, themed(colours::kJoint));
  fill(strayed_, strayed, themed(colours::kWarning));
}

void JointMarks::fill(Layer& layer, const std::vector<const JointMark*>& marks, const QColor& colour) {
  MarkCells faces, lines, points;
  for (const JointMark* mark : marks)
    addMark(faces, lines, points, *mark);
  for (vtkPolyData* data : {layer.faces.Get(), layer.lines.Get(), layer.points.Get()})
    data->Initialize();
  layer.faces->SetPoints(faces.points());
  layer.faces->SetPolys(faces.cells());
  layer.lines->SetPoints(lines.points());
  layer.lines->SetLines(lines.cells());
  layer.points->SetPoints(points.points());
  layer.points->SetVerts(points.cells());
  layer.face->SetVisibility(layer.faces->GetNumberOfCells() > 0);
  layer.line->SetVisibility(layer.lines->GetNumberOfCells() > 0);
  layer.point->SetVisibility(layer.points->GetNumberOfCells() > 0);
  for (vtkActor* actor : layer.actors())
    actor->GetProperty()->SetColor(colour.redF(), colour.greenF(), colour.blueF());
}

}  // namespace nearfit::ui
