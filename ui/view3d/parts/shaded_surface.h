#pragma once

#include <cstddef>
#include <span>

#include <glm/vec3.hpp>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "ui/view3d/parts/part_shape.h"

namespace nearfit::ui {

/// Returns a surface with normals at its points.
/// @param pointAt, normalAt  Position and normal of each of `count` points, by its index.
template <class PointAt, class NormalAt>
vtkSmartPointer<vtkPolyData> shadedSurface(std::size_t count, PointAt&& pointAt, NormalAt&& normalAt,
                                           std::span<const Triangle> triangles) {
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(count));
  const auto normals = vtkSmartPointer<vtkFloatArray>::New();
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3& p = pointAt(i);
    const auto at = static_cast<vtkIdType>(i);
    points->SetPoint(at, p.x, p.y, p.z);
    normals->SetTypedTuple(at, &normalAt(i).x);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->GetPointData()->SetNormals(normals);
  data->SetPolys(cellsOfTriangles(triangles));
  return data;
}

}  // namespace nearfit::ui
