#include "ui/view3d/parts/part_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkFeatureEdges.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataNormals.h>
#include <vtkQuadricClustering.h>

#include "core/base/error.h"

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

/// Edges sharper than this are drawn as lines and get split normals [degrees]. Facets of finely tessellated
/// cylinders stay below it.
constexpr double kFeatureAngle = 30.0;

/// Progress after each stage.
constexpr double kNormalsMade = 0.35, kEdgesMade = 0.6, kDraftsMade = 0.85;

vtkSmartPointer<vtkPolyData> trianglesOf(const TriangleMesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices().size()));
  vtkIdType index = 0;
  for (const glm::dvec3& p : mesh.vertices())
    points->SetPoint(index++, p.x, p.y, p.z);

  vtkNew<vtkCellArray> triangles;
  triangles->AllocateExact(static_cast<vtkIdType>(mesh.triangles().size()),
                           3 * static_cast<vtkIdType>(mesh.triangles().size()));
  for (const Triangle& t : mesh.triangles()) {
    const vtkIdType corners[3] = {t[0], t[1], t[2]};
    triangles->InsertNextCell(3, corners);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(triangles);
  return data;
}

/// Draws without a noticeable wait, in software OpenGL too.
constexpr vtkIdType kPieceTriangles = 100'000;

std::vector<vtkSmartPointer<vtkPolyData>> piecesOf(vtkPolyData& surface) {
  const vtkIdType count = surface.GetNumberOfPolys();
  if (count <= kPieceTriangles) return {&surface};
  std::vector<vtkSmartPointer<vtkPolyData>> pieces;
  for (vtkIdType begin = 0; begin < count; begin += kPieceTriangles) {
    const vtkIdType end = std::min(begin + kPieceTriangles, count);
    vtkNew<vtkCellArray> triangles;
    triangles->AllocateExact(end - begin, 3 * (end - begin));
    for (vtkIdType cell = begin; cell < end; ++cell) {
      vtkIdType size = 0;
      const vtkIdType* corners = nullptr;
      surface.GetPolys()->GetCellAtId(cell, size, corners);
      triangles->InsertNextCell(size, corners);
    }
    auto piece = vtkSmartPointer<vtkPolyData>::New();
    piece->SetPoints(surface.GetPoints());
    piece->GetPointData()->SetNormals(surface.GetPointData()->GetNormals());
    piece->SetPolys(triangles);
    pieces.push_back(piece);
  }
  return pieces;
}

/// Sums the lengths of two-point lines.
double lengthOf(vtkPolyData& edges) {
  double length = 0.0;
  vtkNew<vtkIdList> ends;
  for (edges.GetLines()->InitTraversal(); edges.GetLines()->GetNextCell(ends) != 0;) {
    glm::dvec3 from, to;
    edges.GetPoint(ends->GetId(0), &from.x);
    edges.GetPoint(ends->GetId(1), &to.x);
    length += glm::distance(from, to);
  }
  return length;
}

void addDrafts(PartShape& shape) {
  const auto sizeOf = [](vtkPolyData& data) {
    return static_cast<std::size_t>(data.GetNumberOfPolys() + data.GetNumberOfLines());
  };
  shape.levels = {{sizeOf(*shape.surface) + sizeOf(*shape.edges), 0.0}};
  for (DraftSurface& draft : draftsOf(*shape.surface)) {
    shape.levels.push_back({sizeOf(*draft.surface), draft.cell});
    shape.drafts.push_back(draft.surface);
  }
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

PartShape makePartShape(const TriangleMesh& mesh, const ProgressCallback& progress) {
  const auto report = [&progress](double fraction) {
    if (progress && !progress(fraction)) throw Cancelled();
  };
  const auto triangles = trianglesOf(mesh);
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(triangles);
  normals->SetFeatureAngle(kFeatureAngle);
  normals->SplittingOn();
  // Trust the mesh's orientation: guessing another would hide a fault in the file.
  normals->ConsistencyOff();
  normals->AutoOrientNormalsOff();
  normals->Update();
  report(kNormalsMade);

  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(triangles);
  edges->SetFeatureAngle(kFeatureAngle);
  edges->FeatureEdgesOn();
  edges->BoundaryEdgesOn();
  edges->NonManifoldEdgesOn();
  edges->ManifoldEdgesOff();
  edges->ColoringOff();
  edges->Update();
  report(kEdgesMade);
  PartShape shape;
  shape.surface = normals->GetOutput();
  shape.edges = edges->GetOutput();
  shape.edgeLength = lengthOf(*shape.edges);
  shape.pieces = piecesOf(*shape.surface);
  addDrafts(shape);
  report(kDraftsMade);
  shape.locator = vtkSmartPointer<vtkStaticCellLocator>::New();
  shape.locator->SetDataSet(shape.surface);
  shape.locator->BuildLocator();
  report(1.0);
  return shape;
}

std::shared_ptr<const PartShape> PartShapeCache::shapeOf(const PartGeometryPtr& geometry,
                                                         const ProgressCallback& progress) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(geometry.get());
    if (found != entries_.end() && !found->second.geometry.expired()) return found->second.shape;
  }
  // Not under the lock: preparing a large mesh must not hold up drawing another.
  const auto shape = std::make_shared<PartShape>(makePartShape(geometry->mesh, progress));
  // With several components, each may be inside out.
  shape->hidesItsInside =
      geometry->mass.basis == MassBasis::VolumeIntegrals && geometry->mesh.topology().components == 1;
  const std::lock_guard lock(mutex_);
  dropUnused();
  entries_[geometry.get()] = {geometry, shape};
  return shape;
}

void PartShapeCache::prepare(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress) {
  // An empty mesh takes some work too.
  const auto workOf = [](const PartGeometryPtr& geometry) {
    return 1.0 + static_cast<double>(geometry->mesh.triangles().size());
  };
  double whole = 0.0, done = 0.0;
  for (const PartGeometryPtr& geometry : geometries)
    whole += workOf(geometry);
  for (const PartGeometryPtr& geometry : geometries) {
    const double work = workOf(geometry);
    const auto report = [&](double fraction) {
      return !progress || progress(std::min(1.0, (done + fraction * work) / whole));
    };
    shapeOf(geometry, report);
    done += work;
    if (!report(0.0)) throw Cancelled();
  }
}

void PartShapeCache::dropUnused() {
  std::erase_if(entries_, [](const auto& entry) { return entry.second.geometry.expired(); });
}

}  // namespace nearfit::ui
