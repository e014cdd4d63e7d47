#include "ui/view3d/parts/scene_cut.h"

#include <algorithm>
#include <cmath>

#include <vtkProperty.h>

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

}  // namespace nearfit::ui
