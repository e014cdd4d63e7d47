#include "ui/view3d/parts/coloured_surface.h"

#include <algorithm>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include "core/report/clearance_colours.h"
#include "ui/view3d/parts/part_shape.h"
#include "ui/view3d/parts/shaded_surface.h"

namespace nearfit::ui {
namespace {

constexpr int kTableColours = 256;
/// Share of grey in colours of a former pose, and its lightness.
constexpr double kPale = 0.65, kPaleGrey = 0.62;

/// The value that is drawn.
double scalarOf(double distance, double range) noexcept {
  if (std::isnan(distance)) return ColouredSurface::kBeyond * range;
  // Contact to rounding is not dark, as an overlap is.
  return distance < 0.0 && distance >= -kContactDistance ? 0.0 : distance;
}

Colour paled(const Colour& colour) noexcept {
  const auto mixed = [](float channel) {
    return static_cast<float>((1.0 - kPale) * static_cast<double>(channel) + kPale * kPaleGrey);
  };
  return {mixed(colour.r), mixed(colour.g), mixed(colour.b)};
}

/// Returns the triangles with a corner within the range, in quick pieces; none if there are none.
std::vector<vtkSmartPointer<vtkPolyData>> nearPiecesOf(vtkPolyData& surface, double range) {
  vtkDataArray* clearances = surface.GetPointData()->GetScalars();
  vtkNew<vtkCellArray> triangles;
  for (vtkIdType cell = 0; cell < surface.GetNumberOfPolys(); ++cell) {
    vtkIdType size = 0;
    const vtkIdType* corners = nullptr;
    surface.GetPolys()->GetCellAtId(cell, size, corners);
    const auto isNear = [&](vtkIdType corner) { return clearances->GetTuple1(corner) <= range; };
    if (std::any_of(corners, corners + size, isNear)) triangles->InsertNextCell(size, corners);
  }
  if (triangles->GetNumberOfCells() == 0) return {};
  const auto near = vtkSmartPointer<vtkPolyData>::New();
  near->SetPoints(surface.GetPoints());
  near->GetPointData()->SetNormals(surface.GetPointData()->GetNormals());
  near->GetPointData()->SetScalars(clearances);
  near->SetPolys(triangles);
  return quickPiecesOf(*near);
}

}  // namespace

std::shared_ptr<const ColouredSurface> colouredSurface(const MappedSurface& mapped, double range) {
  const SampledSurface& surface = *mapped.surface;
  const auto data = shadedSurface(
      surface.points.size(), [&](std::size_t i) -> const glm::dvec3& { return surface.points[i]; },
      [&](std::size_t i) -> const glm::vec3& { return surface.normals[i]; }, surface.triangles);
  vtkNew<vtkDoubleArray> clearances;
  clearances->SetName("Clearance");
  clearances->SetNumberOfTuples(data->GetNumberOfPoints());
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    clearances->SetValue(i, scalarOf(mapped.distances[static_cast<std::size_t>(i)], range));
  data->GetPointData()->SetScalars(clearances);
  auto coloured = std::make_shared<ColouredSurface>();
  coloured->pieces = quickPiecesOf(*data);
  coloured->nearPieces = nearPiecesOf(*data, range);
  coloured->triangles = surface.triangles.size();
  coloured->range = range;
  return coloured;
}

void setClearanceColours(vtkLookupTable& table, double range, const Colour& own, bool isStale) {
  table.SetNumberOfTableValues(kTableColours);
  table.SetTableRange(0.0, range);
  const auto shown = [isStale](const Colour& colour) { return isStale ? paled(colour) : colour; };
  for (int i = 0; i < kTableColours; ++i) {
    const Colour c = shown(clearanceColour(range * i / (kTableColours - 1), range));
    table.SetTableValue(i, static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b));
  }
  const Colour overlap = shown(kOverlapColour);
  table.SetBelowRangeColor(static_cast<double>(overlap.r), static_cast<double>(overlap.g),
                           static_cast<double>(overlap.b), 1.0);
  table.UseBelowRangeColorOn();
  table.SetAboveRangeColor(static_cast<double>(own.r), static_cast<double>(own.g), static_cast<double>(own.b),
                           1.0);
  table.UseAboveRangeColorOn();
  table.Modified();
}

}  // namespace nearfit::ui
