#include "ui/scene_renderer.h"

#include <algorithm>
#include <utility>

#include <vtkBoundingBox.h>
#include <vtkCellPicker.h>

namespace nearfit::ui {

SceneRenderer::SceneRenderer(vtkRenderer& renderer, std::shared_ptr<PartShapeCache> shapes, vtkRenderer* over)
    : renderer_(renderer), shapes_(std::move(shapes)), over_(over) {}

void SceneRenderer::setScene(const Scene& scene) {
  scene_ = scene;
  std::erase_if(actors_, [&](const auto& entry) { return scene_.find(entry.first) == nullptr; });
  applyAll();
}

void SceneRenderer::setSelected(std::vector<PartId> parts) {
  selected_ = std::move(parts);
  std::ranges::sort(selected_);
  applyAll();
}

void SceneRenderer::setSeeThrough(bool isSeeThrough) {
  isSeeThrough_ = isSeeThrough;
  applyAll();
}

void SceneRenderer::setEdgesVisible(bool isVisible) {
  hasEdges_ = isVisible;
  applyAll();
}

void SceneRenderer::setPoseInHand(std::optional<RigidTransform> worldFromMoving) {
  poseInHand_ = std::move(worldFromMoving);
  if (!scene_.movingPart()) return;
  const Part* part = scene_.find(*scene_.movingPart());
  if (part != nullptr) actorOf(*part).setPose(shownPose(*part));
}

void SceneRenderer::setDragged(std::map<PartId, RigidTransform> worldFromPart) {
  const std::map<PartId, RigidTransform> before = std::exchange(dragged_, std::move(worldFromPart));
  const auto place = [this](PartId id) {
    const Part* part = scene_.find(id);
    if (part != nullptr) actorOf(*part).setPose(shownPose(*part));
  };
  for (const auto& [id, pose] : before)
    place(id);
  for (const auto& [id, pose] : dragged_)
    place(id);
}

RigidTransform SceneRenderer::shownPose(const Part& part) const {
  const auto dragged = dragged_.find(part.id);
  if (dragged != dragged_.end()) return dragged->second;
  return scene_.movingPart() == part.id ? poseInHand_.value_or(part.worldFromPart) : part.worldFromPart;
}

void SceneRenderer::setOverlapping(std::span<const PartId> parts) {
  if (std::equal(parts.begin(), parts.end(), overlapping_.begin(), overlapping_.end())) return;
  overlapping_.assign(parts.begin(), parts.end());
  applyAll();
}

PartActor& SceneRenderer::actorOf(const Part& part) {
  std::unique_ptr<PartActor>& actor = actors_[part.id];
  auto shape = shapes_->shapeOf(part.geometry);
  if (actor == nullptr || actor->shape() != shape.get()) {
    actor = std::make_unique<PartActor>(renderer_, std::move(shape), over_);
  }
  return *actor;
}

void SceneRenderer::applyAppearance(const Part& part) {
  PartLook look;
  look.isMoving = scene_.movingPart() == part.id;
  look.isSelected = std::ranges::binary_search(selected_, part.id);
  look.isTranslucent = isSeeThrough_ && scene_.movingPart().has_value() && !look.isMoving;
  look.isOverlapping = std::find(overlapping_.begin(), overlapping_.end(), part.id) != overlapping_.end();
  look.hasEdges = hasEdges_;
  look.opacity = part.opacity;
  PartActor& actor = actorOf(part);
  actor.setAppearance(part.colour, part.isVisible, look);
  actor.setPose(shownPose(part));
}

void SceneRenderer::applyAll() {
  for (const Scene::PartPtr& part : scene_.parts())
    applyAppearance(*part);
}

bool SceneRenderer::visibleBounds(double bounds[6]) const {
  vtkBoundingBox box;
  for (const auto& [id, actor] : actors_) {
    if (actor->surface()->GetVisibility() != 0) box.AddBounds(actor->surface()->GetBounds());
  }
  if (box.IsValid() == 0) return false;
  box.GetBounds(bounds);
  return true;
}

bool SceneRenderer::boundsOf(PartId part, double bounds[6]) const {
  const auto found = actors_.find(part);
  if (found == actors_.end()) return false;
  found->second->surface()->GetBounds(bounds);
  return true;
}

std::optional<PickedPoint> SceneRenderer::pickPoint(double x, double y) {
  vtkNew<vtkCellPicker> picker;
  picker->SetTolerance(0.0005);
  picker->PickFromListOn();
  for (const auto& [id, actor] : actors_) {
    if (actor->surface()->GetVisibility() == 0) continue;
    picker->AddPickList(actor->surface());
    picker->AddLocator(actor->locator());
  }
  if (picker->Pick(x, y, 0.0, &renderer_) == 0) return std::nullopt;
  for (const auto& [id, actor] : actors_) {
    if (actor->surface() != picker->GetActor()) continue;
    const double* point = picker->GetPickPosition();
    // Normals split vertices, and leave the triangles in their order.
    return PickedPoint{id, {point[0], point[1], point[2]}, static_cast<std::uint32_t>(picker->GetCellId())};
  }
  return std::nullopt;
}

}  // namespace nearfit::ui
