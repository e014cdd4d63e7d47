#include "ui/lmd_overlay.h"

#include <vtkCellArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/distance_colours.h"
#include "ui/pixel_sizes.h"

namespace nearfit::ui {
namespace {

constexpr double kHalo[3] = {0.08, 0.10, 0.12};
/// Opacity of what is blocked: seen when it is looked for.
constexpr double kFaint = 0.35;

/// Sizes are in pixels, so that a gap of micrometres between metre-long parts is still seen.
void setUp(vtkActor& actor, vtkPolyData& data, bool isColoured, float lineWidth, float pointSize) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(&data);
  mapper->SetScalarVisibility(isColoured);
  if (isColoured) {
    mapper->SetLookupTable(distanceLookupTable());
    mapper->SetScalarRange(0.0, 1.0);
  }
  actor.SetMapper(mapper);
  actor.PickableOff();
  vtkProperty* property = actor.GetProperty();
  property->LightingOff();
  property->SetColor(kHalo[0], kHalo[1], kHalo[2]);
  property->SetLineWidth(devicePixels(lineWidth));
  property->SetPointSize(devicePixels(pointSize));
}

/// What is drawn of a set of minima.
struct Glyphs {
  Glyphs() { points->SetDataTypeToDouble(); }

  void add(const Lmd& lmd, double cutoff) {
    vtkIdType ends[2];
    int end = 0;
    for (const glm::dvec3& p : {lmd.scenePoint, lmd.partPoint}) {
      ends[end] = points->InsertNextPoint(p.x, p.y, p.z);
      vertices->InsertNextCell(1, &ends[end++]);
      fractions->InsertNextValue(lmd.distance / cutoff);
    }
    lines->InsertNextCell(2, ends);
  }

  void fill(vtkPolyData& data, vtkCellArray* lineCells, vtkCellArray* vertexCells) const {
    data.SetPoints(points);
    if (lineCells != nullptr) data.SetLines(lineCells);
    if (vertexCells != nullptr) data.SetVerts(vertexCells);
    data.GetPointData()->SetScalars(fractions);
  }

  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines, vertices;
  vtkNew<vtkDoubleArray> fractions;
};

}  // namespace

LmdOverlay::LmdOverlay(vtkRenderer& renderer) {
  // Later actors win where depths are equal: the dark halo first, colours over it.
  setUp(*halo_, *segments_.Get(), false, 4.5F, 1.0F);
  setUp(*lines_, *segments_.Get(), true, 2.5F, 1.0F);
  setUp(*dots_, *points_.Get(), true, 1.0F, 8.0F);
  vtkProperty* dots = dots_->GetProperty();
  dots->SetRenderPointsAsSpheres(true);
  dots->LightingOn();
  dots->SetAmbient(0.45);
  dots->SetDiffuse(0.65);
  setUp(*faint_, *blocked_.Get(), true, 1.5F, 1.0F);
  faint_->GetProperty()->SetOpacity(kFaint);
  for (vtkActor* actor : {halo_.Get(), lines_.Get(), dots_.Get(), faint_.Get()})
    renderer.AddActor(actor);
}

void LmdOverlay::show(std::span<const SnapshotLmd> lmds, double cutoff) {
  Glyphs open, blocked;
  for (const SnapshotLmd& entry : lmds)
    (entry.lmd.isBlocked ? blocked : open).add(entry.lmd, cutoff);
  open.fill(*segments_, open.lines, nullptr);
  open.fill(*points_, nullptr, open.vertices);
  blocked.fill(*blocked_, blocked.lines, nullptr);
}

void LmdOverlay::setVisible(bool isVisible) {
  for (vtkActor* actor : {halo_.Get(), lines_.Get(), dots_.Get(), faint_.Get()})
    actor->SetVisibility(isVisible);
}

}  // namespace nearfit::ui
