#include "ui/view3d/glyphs/lmd_overlay.h"

#include <algorithm>
#include <utility>

#include <vtkCellArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/view3d/vtk/pixel_sizes.h"
#include "ui/widgets/distance_colours.h"

namespace nearfit::ui {
namespace {

constexpr double kHalo[3] = {0.08, 0.10, 0.12};
/// Opacity of blocked minima: visible to those who look for them.
constexpr double kFaint = 0.35;
/// Length of a normal, as a fraction of the cutoff.
constexpr double kPinOfCutoff = 0.4;

/// Sizes are in pixels, so that gaps of micrometres between parts of metres are visible.
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

/// Collects lines and points of a set of minima.
struct Glyphs {
  Glyphs() { points->SetDataTypeToDouble(); }

  /// @param range  Distance at the end of the colour scale [m].
  void add(const Lmd& lmd, double range) { addLine(lmd.scenePoint, lmd.partPoint, lmd.distance / range); }

  /// Adds the normals at both points.
  void addPins(const Lmd& lmd, double cutoff, double range) {
    const glm::dvec3 pin = kPinOfCutoff * cutoff * lmd.direction;
    addLine(lmd.scenePoint, lmd.scenePoint + pin, lmd.distance / range);
    addLine(lmd.partPoint, lmd.partPoint - pin, lmd.distance / range);
  }

  void addLine(const glm::dvec3& from, const glm::dvec3& to, double fraction) {
    vtkIdType ends[2];
    int end = 0;
    for (const glm::dvec3& p : {from, to}) {
      ends[end] = points->InsertNextPoint(p.x, p.y, p.z);
      vertices->InsertNextCell(1, &ends[end++]);
      fractions->InsertNextValue(fraction);
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
  // Later actors win at equal depth: the dark halo first, colours over it.
  setUp(*halo_, *segments_.Get(), false, 4.5F, 1.0F);
  setUp(*lines_, *segments_.Get(), true, 2.5F, 1.0F);
  setUp(*pins_, *normals_.Get(), true, 1.5F, 1.0F);
  setUp(*dots_, *points_.Get(), true, 1.0F, 8.0F);
  setUp(*nearestHalo_, *nearest_.Get(), false, 8.0F, 1.0F);
  setUp(*nearestLine_, *nearest_.Get(), true, 5.0F, 1.0F);
  setUp(*nearestDots_, *nearest_.Get(), true, 5.0F, 13.0F);
  nearestDots_->GetProperty()->SetRepresentationToPoints();
  for (vtkActor* actor : {dots_.Get(), nearestDots_.Get()}) {
    vtkProperty* dots = actor->GetProperty();
    dots->SetRenderPointsAsSpheres(true);
    dots->LightingOn();
    dots->SetAmbient(0.45);
    dots->SetDiffuse(0.65);
  }
  setUp(*faint_, *blocked_.Get(), true, 1.5F, 1.0F);
  for (vtkActor* actor : {halo_.Get(), lines_.Get(), pins_.Get(), dots_.Get(), faint_.Get(),
                          nearestHalo_.Get(), nearestLine_.Get(), nearestDots_.Get()})
    renderer.AddActor(actor);
  setOpacity(1.0);
  applyVisibility();
}

void LmdOverlay::show(std::span<const SnapshotLmd> lmds, double cutoff, double margin, double time) {
  Glyphs open, blocked, nearest, pins;
  bool isFirst = true;
  const std::vector<SnapshotLmd> chosen = chosenMinima(lmds, cutoff, choice_);
  colours_.see(chosen, margin, time);
  const double range = colours_.end();
  for (const SnapshotLmd& entry : chosen) {
    if (entry.lmd.isBlocked) {
      blocked.add(entry.lmd, range);
      continue;
    }
    open.add(entry.lmd, range);
    if (choice_.hasNormals) pins.addPins(entry.lmd, cutoff, range);
    if (std::exchange(isFirst, false)) nearest.add(entry.lmd, range);
  }
  open.fill(*segments_, open.lines, nullptr);
  open.fill(*points_, nullptr, open.vertices);
  pins.fill(*normals_, pins.lines, nullptr);
  blocked.fill(*blocked_, blocked.lines, nullptr);
  nearest.fill(*nearest_, nearest.lines, nullptr);
}

void LmdOverlay::clear() {
  show({}, 1.0);
  colours_.forget();
}

void LmdOverlay::setVisible(bool isVisible) {
  isVisible_ = isVisible;
  applyVisibility();
}

void LmdOverlay::setOpacity(double share) {
  for (vtkActor* actor : {halo_.Get(), lines_.Get(), pins_.Get(), dots_.Get(), nearestHalo_.Get(),
                          nearestLine_.Get(), nearestDots_.Get()})
    actor->GetProperty()->SetOpacity(share);
  faint_->GetProperty()->SetOpacity(kFaint * share);
}

void LmdOverlay::setChoice(const MinimaChoice& choice) {
  choice_ = choice;
  colours_.choose(choice.colourRange);
  applyVisibility();
}

void LmdOverlay::applyVisibility() {
  for (vtkActor* actor : {halo_.Get(), lines_.Get(), faint_.Get(), nearestHalo_.Get(), nearestLine_.Get()})
    actor->SetVisibility(isVisible_ && choice_.hasSegments);
  for (vtkActor* actor : {dots_.Get(), nearestDots_.Get()})
    actor->SetVisibility(isVisible_ && choice_.hasPoints);
  pins_->SetVisibility(isVisible_ && choice_.hasNormals);
}

std::vector<SnapshotLmd> chosenMinima(std::span<const SnapshotLmd> lmds, double cutoff,
                                      const MinimaChoice& choice) {
  std::vector<SnapshotLmd> chosen;
  // No minimum was found beyond the cutoff; comparing would only drop some by rounding.
  const bool isAll = choice.nearerThan >= 1.0;
  for (const SnapshotLmd& entry : lmds) {
    if (isAll || entry.lmd.distance <= choice.nearerThan * cutoff) chosen.push_back(entry);
  }
  std::ranges::stable_sort(chosen, {}, [](const SnapshotLmd& entry) { return entry.lmd.distance; });
  if (choice.most > 0 && chosen.size() > choice.most) chosen.resize(choice.most);
  return chosen;
}

}  // namespace nearfit::ui
