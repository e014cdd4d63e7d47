#include "ui/view3d/parts/scene_renderer.h"

#include <algorithm>
#include <utility>

#include <vtkBoundingBox.h>

#include "ui/model/shown_poses.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

SceneRenderer::SceneRenderer(vtkRenderer& renderer, std::shared_ptr<PartShapeCache> shapes,
                             const ShownPoses& poses, vtkRenderer* over)
    : renderer_(renderer), shapes_(std::move(shapes)), over_(over), poses_(poses), cut_(renderer) {}

void SceneRenderer::setScene(const Scene& scene) {
  scene_ = scene;
  const auto isGone = [&](const auto& entry) { return scene_.find(entry.first) == nullptr; };
  if (std::ranges::any_of(actors_, isGone)) {
    letGoOfKept();
    ++revision_;
    std::erase_if(actors_, isGone);
    std::erase_if(loose_, [&](PartId id) { return scene_.find(id) == nullptr; });
  }
  applyAll();
}

bool SceneRenderer::takeNewShapes() {
  const std::uint64_t before = revision_;
  applyAll();
  return revision_ != before;
}

void SceneRenderer::makeShapes() {
  if (!shapes_->hasPostponed()) return;
  shapes_->makePostponed();
  takeNewShapes();
}

void SceneRenderer::setSelected(std::vector<PartId> parts) {
  selected_ = std::move(parts);
  std::ranges::sort(selected_);
  applyAll();
}

void SceneRenderer::setHighlighted(std::vector<PartId> parts) {
  std::ranges::sort(parts);
  if (parts == highlighted_) return;
  highlighted_ = std::move(parts);
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

void SceneRenderer::followTheme() {
  applyAll();
}

void SceneRenderer::place(std::span<const PartId> parts) {
  for (const PartId id : parts) {
    const Part* part = scene_.find(id);
    if (part != nullptr) place(*part);
  }
}

void SceneRenderer::place(const Part& part) {
  if (!actorOf(part).setPose(poses_.shownPoseOf(part))) return;
  if (loose_.insert(part.id).second) ++revision_;
}

void SceneRenderer::settle() {
  if (!loose_.empty()) ++revision_;
  loose_.clear();
}

void SceneRenderer::setCut(const std::optional<ViewCut>& cut) {
  if (cut == cut_.cut()) return;
  cut_.set(cut);
  ++revision_;
  if (cut) return updateCut();
  // No picture updates the cut any more: make all parts whole now.
  cut_.begin(0.0);
  for (const Scene::PartPtr& part : scene_.parts())
    open(actorOf(*part), false);
  cut_.end();
}

void SceneRenderer::open(PartActor& actor, bool isCut) {
  if (actor.mappers().isCut() == isCut) return;
  actor.setMappers(mappers_.mappersOf(actor.mappers().shape(), isCut ? cut_.plane() : nullptr));
  ++revision_;
}

void SceneRenderer::updateCut() {
  if (!cut_.cut()) return;
  double bounds[6];
  cut_.begin(visibleBounds(bounds) ? vtkBoundingBox(bounds).GetDiagonalLength() : 0.0);
  for (const Scene::PartPtr& part : scene_.parts()) {
    PartActor& actor = actorOf(*part);
    const bool isCut = cut_.cuts(scene_.isMoving(part->id));
    open(actor, isCut);
    if (isCut && part->isVisible) cut_.close(*part, actor, poses_.shownPoseOf(*part));
  }
  cut_.end();
}

bool SceneRenderer::setColours(const Colours& colours, bool isStale) {
  const std::uint64_t before = revision_;
  const bool hadColours = std::exchange(hasColours_, false);
  bool areOthers = false;
  for (const auto& [id, actor] : actors_) {
    const auto found = colours.find(id);
    const bool wasColoured = actor->colours() != nullptr;
    if (actor->setColours(found == colours.end() ? nullptr : found->second, isStale)) ++revision_;
    const bool isColoured = actor->colours() != nullptr;
    hasColours_ = hasColours_ || isColoured;
    areOthers = areOthers || wasColoured != isColoured;
  }
  // Maps of one part come several times a second.
  if (areOthers || hadColours != hasColours_) applyAll();
  return revision_ != before;
}

void SceneRenderer::setOverlapping(std::span<const PartId> parts) {
  if (std::equal(parts.begin(), parts.end(), overlapping_.begin(), overlapping_.end())) return;
  overlapping_.assign(parts.begin(), parts.end());
  applyAll();
}

PartActor& SceneRenderer::actorOf(const Part& part) {
  std::unique_ptr<PartActor>& actor = actors_[part.id];
  auto shape = shapes_->shapeOf(part.geometry);
  if (actor == nullptr || &actor->shape() != shape.get()) {
    letGoOfKept();
    ++revision_;
    const bool wasStandIn = actor != nullptr && actor->shape().isStandIn;
    const auto colours = wasStandIn ? actor->colours() : nullptr;
    const bool areStale = wasStandIn && actor->areColoursStale();
    actor = std::make_unique<PartActor>(renderer_, mappers_.mappersOf(shape), over_);
    actor->setPose(poses_.shownPoseOf(part));
    if (colours != nullptr) actor->setColours(colours, areStale);
  }
  return *actor;
}

void SceneRenderer::applyAppearance(const Part& part) {
  PartLook look;
  look.isMoving = scene_.isMoving(part.id);
  look.isSelected = std::ranges::binary_search(selected_, part.id);
  look.isHighlighted = std::ranges::binary_search(highlighted_, part.id);
  look.isTranslucent = isSeeThrough_ && scene_.movingPart().has_value() && !look.isMoving;
  look.isOverlapping = std::find(overlapping_.begin(), overlapping_.end(), part.id) != overlapping_.end();
  look.hasEdges = hasEdges_;
  look.opacity = part.opacity;
  PartActor& actor = actorOf(part);
  look.isBesideColours = hasColours_ && actor.colours() == nullptr;
  look.isDark = isThemeDark();
  if (actor.setAppearance(part.colour, part.isVisible, look)) ++revision_;
  place(part);
}

void SceneRenderer::applyAll() {
  for (const Scene::PartPtr& part : scene_.parts())
    applyAppearance(*part);
}

const PartActor* SceneRenderer::find(PartId part) const {
  const auto found = actors_.find(part);
  return found == actors_.end() ? nullptr : found->second.get();
}

bool SceneRenderer::visibleBounds(double bounds[6]) const {
  vtkBoundingBox box;
  for (const auto& [id, actor] : actors_) {
    if (!actor->isVisible()) continue;
    double own[6];
    actor->bounds(own);
    box.AddBounds(own);
  }
  if (box.IsValid() == 0) return false;
  box.GetBounds(bounds);
  return true;
}

bool SceneRenderer::boundsOf(PartId part, double bounds[6]) const {
  const auto found = actors_.find(part);
  if (found == actors_.end()) return false;
  found->second->bounds(bounds);
  return true;
}

}  // namespace nearfit::ui
