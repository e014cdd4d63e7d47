#include "ui/view3d/parts/part_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkQuadricClustering.h>
#include <vtkUnsignedShortArray.h>

#include "core/base/error.h"
#include "core/math/finite.h"
#include "core/mesh/flat_groups.h"
#include "core/mesh/shaded_mesh.h"
#include "ui/view3d/parts/shaded_surface.h"

namespace nearfit::ui {
namespace {

/// Min triangles of a mesh that gets drafts, and of a draft that gets a coarser one.
constexpr vtkIdType kMinTriangles = 500, kMinOfADraft = 200;
/// Cells along the longest side. Twice the first number would take VTK five times as long; the last serves
/// scenes of a thousand parts.
constexpr std::array kDivisions{96, 28, 8, 4};

/// VTK's own filters for normals and sharp edges look at all faces of a vertex or edge for each of these: fans and
/// books of pages take the square of their number.
vtkSmartPointer<vtkPolyData> surfaceOf(const TriangleMesh& mesh, const ShadedMesh& shaded) {
  return shadedSurface(
      shaded.vertices.size(),
      [&](std::size_t i) -> const glm::dvec3& { return mesh.vertices()[shaded.vertices[i]]; },
      [&](std::size_t i) -> const glm::vec3& { return shaded.normals[i]; }, shaded.triangles);
}

vtkSmartPointer<vtkPolyData> linesOf(const TriangleMesh& mesh, const ShadedMesh& shaded) {
  constexpr vtkIdType kUnused = -1;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  std::vector<vtkIdType> pointOf(mesh.vertices().size(), kUnused);
  const auto pointAt = [&](std::uint32_t vertex) {
    const glm::dvec3& p = mesh.vertices()[vertex];
    if (pointOf[vertex] == kUnused) pointOf[vertex] = points->InsertNextPoint(p.x, p.y, p.z);
    return pointOf[vertex];
  };
  vtkNew<vtkCellArray> lines;
  for (const std::uint32_t edge : shaded.sharpEdges) {
    const MeshEdge& e = mesh.edges()[edge];
    const vtkIdType ends[2] = {pointAt(e.v0), pointAt(e.v1)};
    lines->InsertNextCell(2, ends);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  return data;
}

double lengthOf(const TriangleMesh& mesh, std::span<const std::uint32_t> edges) {
  double length = 0.0;
  for (const std::uint32_t edge : edges) {
    const MeshEdge& e = mesh.edges()[edge];
    length += glm::distance(mesh.vertices()[e.v0], mesh.vertices()[e.v1]);
  }
  return length;
}

/// The triangles of a data set, those that repeat a corner left out. Nullopt if a point is not finite.
std::optional<TriangleMesh> meshOf(vtkPolyData& data) {
  std::vector<glm::dvec3> vertices(static_cast<std::size_t>(data.GetNumberOfPoints()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    data.GetPoint(static_cast<vtkIdType>(i), &vertices[i].x);
    if (!isFinite(vertices[i])) return std::nullopt;
  }
  std::vector<Triangle> triangles;
  for (vtkIdType cell = 0; cell < data.GetNumberOfPolys(); ++cell) {
    vtkIdType size = 0;
    const vtkIdType* corners = nullptr;
    data.GetPolys()->GetCellAtId(cell, size, corners);
    if (size != 3 || corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
      continue;
    triangles.push_back({static_cast<std::uint32_t>(corners[0]), static_cast<std::uint32_t>(corners[1]),
                         static_cast<std::uint32_t>(corners[2])});
  }
  return TriangleMesh(std::move(vertices), std::move(triangles));
}

/// Returns an empty surface if the arithmetic of clustering fails.
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
  // Points of its own would lie beside the surface, and a veil would tint what lies beside the part.
  clustering->UseInputPointsOn();
  clustering->Update();
  const std::optional<TriangleMesh> mesh = meshOf(*clustering->GetOutput());
  const auto draft =
      mesh ? surfaceOf(*mesh, shadedMesh(*mesh, kSharpAngle)) : vtkSmartPointer<vtkPolyData>::New();
  return {draft, cell * std::sqrt(3.0)};
}

/// Progress after each stage.
constexpr double kShaded = 0.35, kConverted = 0.6, kDraftsMade = 0.85;

/// Draws without a noticeable wait, in software OpenGL too.
constexpr vtkIdType kPieceTriangles = 100'000;

/// @param finest  Finest stand-in of the shape, or null.
vtkSmartPointer<vtkPolyData> veilOf(const PartShape& shape, const vtkSmartPointer<vtkPolyData>& finest) {
  // Some 15 ms in software OpenGL, and 30 ms.
  constexpr vtkIdType kQuick = 50'000, kMost = 100'000;
  if (shape.surface->GetNumberOfPolys() <= kQuick) return shape.surface;
  const vtkIdType count = finest != nullptr ? finest->GetNumberOfPolys() : 0;
  return count > 0 && count <= kMost ? finest.Get() : shape.finestDraft();
}

void addDrafts(PartShape& shape) {
  const auto sizeOf = [](vtkPolyData& data) {
    return static_cast<std::size_t>(data.GetNumberOfPolys() + data.GetNumberOfLines());
  };
  shape.levels = {{sizeOf(*shape.surface) + sizeOf(*shape.edges), 0.0}};
  vtkSmartPointer<vtkPolyData> finest;
  for (DraftSurface& draft : draftsOf(*shape.surface, finest)) {
    shape.levels.push_back({sizeOf(*draft.surface), draft.cell});
    shape.drafts.push_back(draft.surface);
  }
  shape.veil = veilOf(shape, finest);
}

}  // namespace

vtkSmartPointer<vtkCellArray> cellsOfTriangles(std::span<const Triangle> triangles) {
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->AllocateExact(static_cast<vtkIdType>(triangles.size()),
                       3 * static_cast<vtkIdType>(triangles.size()));
  for (const Triangle& t : triangles) {
    const vtkIdType corners[3] = {t[0], t[1], t[2]};
    cells->InsertNextCell(3, corners);
  }
  return cells;
}

std::vector<vtkSmartPointer<vtkPolyData>> quickPiecesOf(vtkPolyData& surface) {
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
    piece->GetPointData()->SetScalars(surface.GetPointData()->GetScalars());
    piece->SetPolys(triangles);
    pieces.push_back(piece);
  }
  return pieces;
}

std::vector<DraftSurface> draftsOf(vtkPolyData& surface, vtkSmartPointer<vtkPolyData>& finest) {
  std::vector<DraftSurface> drafts;
  vtkPolyData* last = &surface;
  double off = 0.0;
  for (const int divisions : kDivisions) {
    if (last->GetNumberOfPolys() < (drafts.empty() ? kMinTriangles : kMinOfADraft)) break;
    DraftSurface draft = clustered(*last, divisions);
    if (finest == nullptr) finest = draft.surface;
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

PartShape makePartShape(const TriangleMesh& mesh, double coordinateRounding,
                        const ProgressCallback& progress) {
  const auto report = [&progress](double fraction) {
    if (progress && !progress(fraction)) throw Cancelled();
  };
  const ShadedMesh shaded = shadedMesh(mesh, kSharpAngle, flatTolerance(mesh, coordinateRounding));
  report(kShaded);
  PartShape shape;
  shape.surface = surfaceOf(mesh, shaded);
  shape.edges = linesOf(mesh, shaded);
  shape.edgeLength = lengthOf(mesh, shaded.sharpEdges);
  report(kConverted);
  shape.pieces = quickPiecesOf(*shape.surface);
  addDrafts(shape);
  report(kDraftsMade);
  shape.rays = RayTree(mesh);
  report(1.0);
  return shape;
}

void addFaceColours(PartShape& shape, const PartGeometry& geometry) {
  const bool isAny =
      std::ranges::any_of(geometry.faceColours, [](const auto& colour) { return colour.has_value(); });
  const auto triangles = static_cast<std::size_t>(shape.surface->GetNumberOfPolys());
  if (!isAny || geometry.surfaces == nullptr || geometry.surfaces->faceOfTriangle.size() != triangles) return;
  std::map<CadColour, unsigned short> numbers;
  // One number stays for the part's own colour.
  constexpr std::size_t kMaxColours = std::numeric_limits<unsigned short>::max();
  std::vector<unsigned short> numberOfFace(geometry.faceColours.size(), 0);
  for (std::size_t face = 0; face < numberOfFace.size(); ++face) {
    const std::optional<CadColour>& colour = geometry.faceColours[face];
    if (!colour || (numbers.size() == kMaxColours && !numbers.contains(*colour))) continue;
    const auto [number, isNew] =
        numbers.try_emplace(*colour, static_cast<unsigned short>(shape.faceColours.size() + 1));
    if (isNew) shape.faceColours.push_back(*colour);
    numberOfFace[face] = number->second;
  }
  shape.hasOwnColour = false;
  std::size_t triangle = 0;
  for (vtkPolyData* piece : shape.pieces) {
    vtkNew<vtkUnsignedShortArray> scalars;
    scalars->SetName("Face colours");
    scalars->SetNumberOfTuples(piece->GetNumberOfPolys());
    for (vtkIdType cell = 0; cell < piece->GetNumberOfPolys(); ++cell) {
      const std::uint32_t face = geometry.surfaces->faceOfTriangle[triangle++];
      const unsigned short number = face < numberOfFace.size() ? numberOfFace[face] : 0;
      scalars->SetValue(cell, number);
      shape.hasOwnColour = shape.hasOwnColour || number == 0;
    }
    auto coloured = vtkSmartPointer<vtkPolyData>::New();
    coloured->SetPoints(piece->GetPoints());
    coloured->GetPointData()->SetNormals(piece->GetPointData()->GetNormals());
    coloured->SetPolys(piece->GetPolys());
    coloured->GetCellData()->SetScalars(scalars);
    shape.colouredPieces.push_back(coloured);
  }
}

PartShape standInFor(const TriangleMesh& mesh) {
  const Aabb box = mesh.bounds();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  constexpr std::uint32_t kCorners = 8;
  for (std::uint32_t corner = 0; corner < kCorners; ++corner) {
    const auto along = [&](std::uint32_t axis) {
      return ((corner >> axis) & 1U) != 0 ? box.upper[static_cast<int>(axis)]
                                          : box.lower[static_cast<int>(axis)];
    };
    points->InsertNextPoint(along(0), along(1), along(2));
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t other = corner | (1U << axis);
      if (other == corner) continue;
      const vtkIdType ends[2] = {corner, other};
      lines->InsertNextCell(2, ends);
    }
  }
  PartShape shape;
  shape.surface = vtkSmartPointer<vtkPolyData>::New();
  shape.surface->SetPoints(points);
  shape.surface->SetLines(lines);
  shape.edges = vtkSmartPointer<vtkPolyData>::New();
  shape.pieces = {shape.surface};
  shape.levels = {{static_cast<std::size_t>(lines->GetNumberOfCells()), 0.0}};
  shape.veil = shape.surface;
  shape.isStandIn = true;
  return shape;
}

std::shared_ptr<const PartShape> PartShapeCache::known(const PartGeometryPtr& geometry) const {
  const auto found = entries_.find(geometry.get());
  return found != entries_.end() && !found->second.geometry.expired() ? found->second.shape : nullptr;
}

std::shared_ptr<const PartShape> PartShapeCache::made(const PartGeometryPtr& geometry,
                                                      const ProgressCallback& progress) {
  const auto shape = std::make_shared<PartShape>(
      makePartShape(geometry->mesh, geometry->report.coordinateRounding, progress));
  addFaceColours(*shape, *geometry);
  // With several components, each may be inside out.
  shape->hidesItsInside =
      geometry->mass.basis == MassBasis::VolumeIntegrals && geometry->mesh.topology().components == 1;
  return shape;
}

void PartShapeCache::keep(const PartGeometryPtr& geometry, std::shared_ptr<const PartShape> shape) {
  // Not for each new entry: that would take the square of their number.
  if (entries_.size() >= nextDrop_) dropUnused();
  entries_[geometry.get()] = {geometry, std::move(shape)};
}

std::shared_ptr<const PartShape> PartShapeCache::shapeOf(const PartGeometryPtr& geometry,
                                                         const ProgressCallback& progress) {
  {
    const std::lock_guard lock(mutex_);
    if (auto shape = known(geometry)) return shape;
  }
  // Not under the lock: preparing a large mesh must not hold up drawing another.
  auto shape = made(geometry, progress);
  const std::lock_guard lock(mutex_);
  keep(geometry, shape);
  return shape;
}

void PartShapeCache::prepare(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress) {
  std::vector<PartGeometryPtr> missing;
  std::size_t triangles = 0;
  {
    const std::lock_guard lock(mutex_);
    dropUnused();
    for (const PartGeometryPtr& geometry : geometries) {
      if (known(geometry) != nullptr) continue;
      missing.push_back(geometry);
      triangles += geometry->mesh.triangles().size();
    }
    if (triangles > kMostAtOnce) {
      for (const PartGeometryPtr& geometry : missing) {
        keep(geometry, std::make_shared<const PartShape>(standInFor(geometry->mesh)));
        postponed_.push_back(geometry);
      }
      missing.clear();
    }
  }
  makeAll(missing, progress);
  if (progress && !progress(1.0)) throw Cancelled();
}

void PartShapeCache::makePostponed(const ProgressCallback& progress) {
  std::vector<PartGeometryPtr> missing;
  {
    const std::lock_guard lock(mutex_);
    for (const std::weak_ptr<const PartGeometry>& each : postponed_) {
      PartGeometryPtr geometry = each.lock();
      if (geometry == nullptr) continue;
      const auto shape = known(geometry);
      if (shape == nullptr || shape->isStandIn) missing.push_back(std::move(geometry));
    }
  }
  makeAll(missing, progress);
  const std::lock_guard lock(mutex_);
  // Others may have been postponed meanwhile.
  std::erase_if(postponed_, [this](const std::weak_ptr<const PartGeometry>& each) {
    const PartGeometryPtr geometry = each.lock();
    const auto shape = geometry == nullptr ? nullptr : known(geometry);
    return shape == nullptr || !shape->isStandIn;
  });
}

bool PartShapeCache::hasPostponed() const {
  const std::lock_guard lock(mutex_);
  return !postponed_.empty();
}

void PartShapeCache::makeAll(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress) {
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
    auto shape = made(geometry, report);
    {
      const std::lock_guard lock(mutex_);
      keep(geometry, std::move(shape));
    }
    done += work;
    if (!report(0.0)) throw Cancelled();
  }
}

void PartShapeCache::dropUnused() {
  std::erase_if(entries_, [](const auto& entry) { return entry.second.geometry.expired(); });
  nextDrop_ = 2 * entries_.size() + kFewShapes;
}

}  // namespace nearfit::ui
