#include "ui/scene_renderer.h"

#include <algorithm>
#include <utility>

#include <vtkBoundingBox.h>
#include <vtkCellPicker.h>

namespace nearfit::ui {

SceneRenderer::SceneRenderer(vtkRenderer& renderer, std::shared_ptr<PartShapeCache> shapes)
    : renderer_(renderer), shapes_(std::move(shapes)) {}

void SceneRenderer::setScene(const Scene& scene) {
  scene_ = scene;
  std::erase_if(actors_, [&](const auto& entry) { return scene_.find(entry.first) == nullptr; });
  applyAll();
}

void SceneRenderer::setSelected(std::optional<PartId> part) {
  selected_ = part;
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
  if (part != nullptr) actorOf(*part).setPose(poseInHand_.value_or(part->worldFromPart));
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
    actor = std::make_unique<PartActor>(renderer_, std::move(shape));
  }
  return *actor;
}

void SceneRenderer::applyAppearance(const Part& part) {
  PartLook look;
  look.isMoving = scene_.movingPart() == part.id;
  look.isSelected = selected_ == part.id;
  look.isTranslucent = isSeeThrough_ && scene_.movingPart().has_value() && !look.isMoving;
  look.isOverlapping = std::find(overlapping_.begin(), overlapping_.end(), part.id) != overlapping_.end();
  look.hasEdges = hasEdges_;
  PartActor& actor = actorOf(part);
  actor.setAppearance(part.colour, part.isVisible, look);
  actor.setPose(look.isMoving ? poseInHand_.value_or(part.worldFromPart) : part.worldFromPart);
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

std::optional<PartId> SceneRenderer::pick(double x, double y) {
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
    if (actor->surface() == picker->GetActor()) return id;
  }
  return std::nullopt;
}

}  // namespace nearfit::ui
