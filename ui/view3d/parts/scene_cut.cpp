#include "ui/view3d/parts/scene_cut.h"

#include <QColor>
#include <algorithm>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/view3d/vtk/pixel_sizes.h"

namespace nearfit::ui {
namespace {

/// Number of stripes across the scene.
constexpr double kStripes = 50.0;
/// Surfaces are drawn this far beyond the plane, as a fraction of the scene's size. That keeps faces that lie
/// in the plane, despite the GPU's single precision.
constexpr double kOver = 2e-6;

/// Rounds to a power of two, so that stripes do not change whenever a part moves.
double stepped(double length) {
  return length > 0.0 ? std::exp2(std::round(std::log2(length))) : 1.0;
}

}  // namespace

SceneCut::SceneCut(vtkRenderer& renderer) : renderer_(renderer), hatch_(makeHatch()) {}

void SceneCut::begin(double size) {
  closed_.clear();
  open_.clear();
  spacing_ = stepped(size / kStripes);
  if (!cut_) return;
  const glm::dvec3 &away = cut_->plane.normal, origin = (cut_->plane.offset + kOver * size) * away;
  plane_->SetNormal(-away.x, -away.y, -away.z);
  plane_->SetOrigin(origin.x, origin.y, origin.z);
}

void SceneCut::close(const Part& part, const PartActor& actor, const RigidTransform& worldFromPart) {
  closed_.push_back(part.id);
  std::unique_ptr<PartCap>& cap = caps_[part.id];
  if (cap == nullptr) cap = std::make_unique<PartCap>(renderer_, hatch_, static_cast<unsigned>(caps_.size()));
  cap->show(part.geometry, worldFromPart, cut_->plane, spacing_);
  cap->setLook(actor.look().GetColor(), part.opacity, &actor.edgeLook());
  if (!cap->section()->isCapped && !cap->section()->outline.empty()) open_.push_back(part.id);
}

void SceneCut::end() {
  std::erase_if(caps_,
                [this](const auto& entry) { return !std::ranges::binary_search(closed_, entry.first); });
}

PlaneSheet::PlaneSheet(vtkRenderer& renderer) : renderer_(&renderer) {
  corners_->SetDataTypeToDouble();
  corners_->SetNumberOfPoints(4);
  const vtkIdType round[] = {0, 1, 2, 3, 0};
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(5, round);
  outline_->SetPoints(corners_);
  outline_->SetLines(lines);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(outline_);
  actor_->SetMapper(mapper);
  actor_->PickableOff();
  actor_->GetProperty()->LightingOff();
  actor_->GetProperty()->SetLineWidth(devicePixels(1.6F));
  actor_->VisibilityOff();
  renderer.AddActor(actor_);
}

PlaneSheet::~PlaneSheet() {
  if (renderer_ != nullptr) renderer_->RemoveActor(actor_);
}

void PlaneSheet::show(const CutPlane& plane, const Aabb& box, const QColor& colour) {
  const auto corners = sheetOf(plane, box);
  for (vtkIdType i = 0; i < 4; ++i) {
    const glm::dvec3& corner = corners[static_cast<std::size_t>(i)];
    corners_->SetPoint(i, corner.x, corner.y, corner.z);
  }
  corners_->Modified();
  outline_->Modified();
  actor_->GetProperty()->SetColor(colour.redF(), colour.greenF(), colour.blueF());
  actor_->VisibilityOn();
}

void PlaneSheet::clear() {
  actor_->VisibilityOff();
}

}  // namespace nearfit::ui
