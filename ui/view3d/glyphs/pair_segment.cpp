#include "ui/view3d/glyphs/pair_segment.h"

#include <vtkCellArray.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>

#include "ui/view3d/vtk/pixel_sizes.h"

namespace nearfit::ui {
namespace {

void setUp(vtkActor& actor, vtkPolyData& data, const QColor& colour, float size) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(&data);
  // Thinner lines and dots lie over wider ones.
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0.0, static_cast<double>(size));
  mapper->SetRelativeCoincidentTopologyPointOffsetParameter(static_cast<double>(size));
  actor.SetMapper(mapper);
  actor.PickableOff();
  vtkProperty& look = *actor.GetProperty();
  look.LightingOff();
  look.SetColor(colour.redF(), colour.greenF(), colour.blueF());
  look.SetLineWidth(devicePixels(size));
  look.SetPointSize(devicePixels(size));
}

/// Draws dots as discs. VTK's spheres bulge towards the eye by their radius, so those of the rims
/// would hide the dots inside.
void makeRound(vtkActor& actor) {
  actor.GetShaderProperty()->AddFragmentShaderReplacement(
      "//VTK::Normal::Impl", true,
      "  vec2 fromMiddle = 2.0 * gl_PointCoord - vec2(1.0);\n"
      "  if (dot(fromMiddle, fromMiddle) > 1.0) discard;\n"
      "//VTK::Normal::Impl",
      false);
}

}  // namespace

PairSegment::PairSegment(vtkRenderer& overlay, const QColor& colour) : overlay_(&overlay) {
  ends_->SetDataTypeToDouble();
  ends_->SetNumberOfPoints(2);
  vtkNew<vtkCellArray> line, dots;
  const vtkIdType both[] = {0, 1};
  line->InsertNextCell(2, both);
  for (const vtkIdType& end : both)
    dots->InsertNextCell(1, &end);
  segment_->SetPoints(ends_);
  segment_->SetLines(line);
  dots_->SetPoints(ends_);
  dots_->SetVerts(dots);
  // Later actors win at equal depth: the white rim first, the colour over it.
  setUp(*halo_, *segment_.Get(), Qt::white, 7.0F);
  setUp(*rims_, *dots_.Get(), Qt::white, 15.0F);
  setUp(*line_, *segment_.Get(), colour, 3.5F);
  setUp(*points_, *dots_.Get(), colour, 10.0F);
  for (vtkActor* actor : {rims_.Get(), points_.Get()})
    makeRound(*actor);
  for (vtkActor* actor : {halo_.Get(), rims_.Get(), line_.Get(), points_.Get()})
    overlay.AddActor(actor);
  applyVisibility();
}

PairSegment::~PairSegment() {
  if (overlay_ == nullptr) return;
  for (vtkActor* actor : {halo_.Get(), rims_.Get(), line_.Get(), points_.Get()})
    overlay_->RemoveActor(actor);
}

void PairSegment::show(const glm::dvec3& from, const glm::dvec3& to) {
  ends_->SetPoint(0, from.x, from.y, from.z);
  ends_->SetPoint(1, to.x, to.y, to.z);
  ends_->Modified();
  segment_->Modified();
  dots_->Modified();
  isShown_ = true;
  applyVisibility();
}

void PairSegment::clear() {
  isShown_ = false;
  applyVisibility();
}

void PairSegment::applyVisibility() {
  for (vtkActor* actor : {halo_.Get(), rims_.Get(), line_.Get(), points_.Get()})
    actor->SetVisibility(isShown_);
}

}  // namespace nearfit::ui
