#include "ui/view3d/parts/draft_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataNormals.h>
#include <vtkQuadricClustering.h>

namespace nearfit::ui {
namespace {

/// Min triangles of a mesh that gets drafts, and of a draft that gets a coarser one.
constexpr vtkIdType kMinTriangles = 500, kMinOfADraft = 200;
/// Cells along the longest side. Twice the first number would take VTK five times as long; the last serves
/// scenes of a thousand parts.
constexpr std::array kDivisions{96, 28, 8, 4};
constexpr double kDraftFeatureAngle = 30.0;  ///< As for the surface itself [degrees].

DraftSurface clustered(vtkPolyData& surface, int divisions) {
  const double* bounds = surface.GetBounds();
  std::array<double, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    size[axis] = bounds[2 * axis + 1] - bounds[2 * axis];
  const double cell = *std::ranges::max_element(size) / divisions;
  const auto along = [&](std::size_t axis) {
    return cell > 0.0 ? std::max(1, static_cast<int>(std::ceil(size[axis] / cell))) : 1;
  };
  // Other attributes of the surface would only slow clustering down.
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(surface.GetPoints());
  bare->SetPolys(surface.GetPolys());
  vtkNew<vtkQuadricClustering> clustering;
  clustering->SetInputData(bare);
  clustering->AutoAdjustNumberOfDivisionsOff();
  clustering->SetNumberOfDivisions(along(0), along(1), along(2));
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputConnection(clustering->GetOutputPort());
  normals->SetFeatureAngle(kDraftFeatureAngle);
  normals->SplittingOn();
  normals->ConsistencyOff();
  normals->AutoOrientNormalsOff();
  normals->Update();
  return {normals->GetOutput(), cell * std::sqrt(3.0)};
}

}  // namespace

std::vector<DraftSurface> draftsOf(vtkPolyData& surface) {
  std::vector<DraftSurface> drafts;
  vtkPolyData* last = &surface;
  double off = 0.0;
  for (const int divisions : kDivisions) {
    if (last->GetNumberOfPolys() < (drafts.empty() ? kMinTriangles : kMinOfADraft)) break;
    DraftSurface draft = clustered(*last, divisions);
    // Each draft is made from the one before, which is faster but adds up their deviations.
    draft.cell += off;
    if (draft.surface->GetNumberOfPolys() == 0 ||
        2 * draft.surface->GetNumberOfPolys() > last->GetNumberOfPolys())
      continue;
    off = draft.cell;
    last = draft.surface;
    drafts.push_back(std::move(draft));
  }
  return drafts;
}

}  // namespace nearfit::ui
