#include "ui/view3d/parts/part_cap.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/view3d/vtk/vtk_convert.h"

namespace nearfit::ui {
namespace {

/// Width of the texture, the dark line's share of it, and that line's brightness.
constexpr int kHatchSize = 32;
constexpr double kLineShare = 0.16, kLineShade = 0.5;
/// How much lighter the cut face is than the part's surface.
constexpr double kTint = 0.30;
constexpr double kDepth = 0.3, kDepthStep = 0.1;
/// Angles that stripes take in turn, from the plane's first axis [rad].
constexpr double kLeans[] = {0.25 * std::numbers::pi, 0.75 * std::numbers::pi, std::numbers::pi / 6.0,
                             2.0 * std::numbers::pi / 3.0};

vtkSmartPointer<vtkPoints> pointsOf(const std::vector<glm::dvec3>& points) {
  auto all = vtkSmartPointer<vtkPoints>::New();
  all->SetDataTypeToDouble();
  all->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  vtkIdType index = 0;
  for (const glm::dvec3& p : points)
    all->SetPoint(index++, p.x, p.y, p.z);
  return all;
}

template <std::size_t count>
vtkSmartPointer<vtkCellArray> cellsOf(const std::vector<std::array<std::uint32_t, count>>& cells) {
  auto all = vtkSmartPointer<vtkCellArray>::New();
  all->AllocateExact(static_cast<vtkIdType>(cells.size()),
                     static_cast<vtkIdType>(count) * static_cast<vtkIdType>(cells.size()));
  for (const auto& cell : cells) {
    std::array<vtkIdType, count> ids;
    std::copy(cell.begin(), cell.end(), ids.begin());
    all->InsertNextCell(static_cast<vtkIdType>(count), ids.data());
  }
  return all;
}

/// @param depth  Polygon offset, relative to that of the parts' surfaces.
void addTo(vtkRenderer& renderer, vtkActor& actor, vtkPolyData& data, vtkMatrix4x4& pose, double depth) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(&data);
  mapper->ScalarVisibilityOff();
  // Push the face behind its outline, but less than the parts' surfaces, one of which may lie in it.
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(depth, depth);
  actor.SetMapper(mapper);
  actor.SetUserMatrix(&pose);
  renderer.AddActor(&actor);
}

}  // namespace

vtkSmartPointer<vtkTexture> makeHatch() {
  vtkNew<vtkImageData> image;
  image->SetDimensions(kHatchSize, 1, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int x = 0; x < kHatchSize; ++x) {
    // Soft edges, so that the hatch does not flicker at a distance.
    const double off = std::abs(x + 0.5 - 0.5 * kHatchSize) / kHatchSize - 0.5 * kLineShare;
    const double light = std::clamp(0.5 + off * 0.5 * kHatchSize, 0.0, 1.0);
    auto* pixel = static_cast<unsigned char*>(image->GetScalarPointer(x, 0, 0));
    pixel[0] = pixel[1] = pixel[2] =
        static_cast<unsigned char>(std::lround(255.0 * (kLineShade + (1.0 - kLineShade) * light)));
  }
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(image);
  texture->RepeatOn();
  texture->InterpolateOn();
  texture->MipmapOn();
  return texture;
}

PartCap::PartCap(vtkRenderer& renderer, vtkTexture* hatch, unsigned lean) : renderer_(renderer), lean_(lean) {
  // Different offsets let one of two overlapping parts cover the other, instead of
  // fighting for the same depth.
  const double depth = kDepth + kDepthStep * static_cast<double>(lean_ % std::size(kLeans));
  addTo(renderer_, *face_.Get(), *faces_.Get(), *pose_.Get(), depth);
  addTo(renderer_, *outline_.Get(), *lines_.Get(), *pose_.Get(), depth);
  face_->SetTexture(hatch);
  outline_->PickableOff();
  vtkProperty* look = face_->GetProperty();
  // Evenly lit, whichever way it faces.
  look->SetAmbient(0.75);
  look->SetDiffuse(0.25);
  look->SetSpecular(0.0);
}

PartCap::~PartCap() {
  renderer_.RemoveActor(face_);
  renderer_.RemoveActor(outline_);
}

void PartCap::show(const PartGeometryPtr& geometry, const RigidTransform& worldFromPart,
                   const CutPlane& plane, double spacing) {
  setMatrix(*pose_.Get(), worldFromPart);
  const RigidTransform partFromWorld = worldFromPart.inverse();
  const CutPlane inPart = placed(plane, partFromWorld);
  if (geometry_ == geometry && spacing_ == spacing && plane_ == inPart) return;
  geometry_ = geometry;
  plane_ = inPart;
  spacing_ = spacing;
  section_ = std::make_shared<const MeshSection>(sectionOf(geometry->mesh, inPart));
  const auto [right, up] = axesOf(plane);
  fill({partFromWorld.applyToVector(right), partFromWorld.applyToVector(up)}, spacing);
}

void PartCap::fill(const std::array<glm::dvec3, 2>& stripes, double spacing) {
  const double angle = kLeans[lean_ % std::size(kLeans)];
  const glm::dvec3 across = (std::cos(angle) * stripes[0] + std::sin(angle) * stripes[1]) / spacing;
  faces_->Initialize();
  faces_->SetPoints(pointsOf(section_->capPoints));
  faces_->SetPolys(cellsOf(section_->cap));
  vtkNew<vtkFloatArray> places, normals;
  places->SetNumberOfComponents(2);
  normals->SetNumberOfComponents(3);
  for (const glm::dvec3& p : section_->capPoints) {
    // Measured from the part's origin, so that the stripes move with the part.
    places->InsertNextTuple2(glm::dot(p, across), 0.5);
    normals->InsertNextTuple3(plane_.normal.x, plane_.normal.y, plane_.normal.z);
  }
  faces_->GetPointData()->SetTCoords(places);
  faces_->GetPointData()->SetNormals(normals);
  lines_->Initialize();
  lines_->SetPoints(pointsOf(section_->points));
  lines_->SetLines(cellsOf(section_->outline));
  face_->SetVisibility(!section_->cap.empty());
  outline_->SetVisibility(!section_->outline.empty());
}

void PartCap::setLook(const double colour[3], double opacity, vtkProperty* edges) {
  vtkProperty* look = face_->GetProperty();
  look->SetColor(colour[0] + kTint * (1.0 - colour[0]), colour[1] + kTint * (1.0 - colour[1]),
                 colour[2] + kTint * (1.0 - colour[2]));
  look->SetOpacity(opacity);
  outline_->SetProperty(edges);
}

}  // namespace nearfit::ui
