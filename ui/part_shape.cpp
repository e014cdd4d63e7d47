#include "ui/part_shape.h"

#include <vtkCellArray.h>
#include <vtkFeatureEdges.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyDataNormals.h>

namespace nearfit::ui {
namespace {

/// Edges sharper than this are drawn as lines and not shaded over [degrees]. Finer facets of tessellated
/// cylinders stay below it.
constexpr double kFeatureAngle = 30.0;

vtkSmartPointer<vtkPolyData> trianglesOf(const TriangleMesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices().size()));
  vtkIdType index = 0;
  for (const glm::dvec3& p : mesh.vertices())
    points->SetPoint(index++, p.x, p.y, p.z);

  vtkNew<vtkCellArray> triangles;
  triangles->AllocateExact(static_cast<vtkIdType>(mesh.triangles().size()),
                           static_cast<vtkIdType>(3 * mesh.triangles().size()));
  for (const Triangle& t : mesh.triangles()) {
    const vtkIdType corners[3] = {t[0], t[1], t[2]};
    triangles->InsertNextCell(3, corners);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(triangles);
  return data;
}

}  // namespace

PartShape makePartShape(const TriangleMesh& mesh) {
  const auto triangles = trianglesOf(mesh);
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(triangles);
  normals->SetFeatureAngle(kFeatureAngle);
  normals->SplittingOn();
  // The mesh's own orientation is the truth; guessing another would hide a fault of the file.
  normals->ConsistencyOff();
  normals->AutoOrientNormalsOff();
  normals->Update();

  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(triangles);
  edges->SetFeatureAngle(kFeatureAngle);
  edges->FeatureEdgesOn();
  edges->BoundaryEdgesOn();
  edges->NonManifoldEdgesOn();
  edges->ManifoldEdgesOff();
  edges->ColoringOff();
  edges->Update();
  return {normals->GetOutput(), edges->GetOutput()};
}

std::shared_ptr<const PartShape> PartShapeCache::shapeOf(const PartGeometryPtr& geometry) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(geometry.get());
    if (found != entries_.end() && !found->second.geometry.expired()) return found->second.shape;
  }
  // Outside the lock, so that a large mesh being prepared does not hold up the drawing of another.
  auto shape = std::make_shared<const PartShape>(makePartShape(geometry->mesh));
  const std::lock_guard lock(mutex_);
  dropUnused();
  entries_[geometry.get()] = {geometry, shape};
  return shape;
}

void PartShapeCache::dropUnused() {
  std::erase_if(entries_, [](const auto& entry) { return entry.second.geometry.expired(); });
}

}  // namespace nearfit::ui
