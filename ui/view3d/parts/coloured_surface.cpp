#include "ui/view3d/parts/coloured_surface.h"

#include <algorithm>
#include <cmath>

#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include "core/report/clearance_colours.h"
#include "ui/view3d/parts/part_shape.h"

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

}  // namespace

std::shared_ptr<const ColouredSurface> colouredSurface(const MappedSurface& mapped, double range) {
  const SampledSurface& surface = *mapped.surface;
  const auto count = static_cast<vtkIdType>(surface.points.size());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(count);
  vtkNew<vtkDoubleArray> clearances;
  clearances->SetName("Clearance");
  clearances->SetNumberOfTuples(count);
  for (vtkIdType i = 0; i < count; ++i) {
    const auto sample = static_cast<std::size_t>(i);
    const glm::dvec3& p = surface.points[sample];
    points->SetPoint(i, p.x, p.y, p.z);
    normals->SetTypedTuple(i, &surface.normals[sample].x);
    clearances->SetValue(i, scalarOf(mapped.distances[sample], range));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->GetPointData()->SetNormals(normals);
  data->GetPointData()->SetScalars(clearances);
  data->SetPolys(cellsOfTriangles(surface.triangles));
  auto coloured = std::make_shared<ColouredSurface>();
  coloured->pieces = quickPiecesOf(*data);
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
