#include "ui/model/pose_subject.h"

#include <algorithm>

#include "core/placing/pivot.h"
#include "core/scene/moving_body.h"
#include "core/scene/scene_tree.h"
#include "ui/model/hand_state.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"

namespace nearfit::ui {
namespace {

bool areMoving(const Scene& scene, const std::vector<PartId>& parts) {
  return std::ranges::all_of(parts, [&scene](PartId part) { return scene.isMoving(part); });
}

bool areMovingGroup(const Scene& scene, const std::vector<PartId>& parts) {
  return scene.movingGroup() && areMoving(scene, parts) && parts.size() == scene.movingParts().size();
}

PoseSubject groupInHand(const Scene& scene) {
  PoseSubject group{scene.movingParts(), true};
  std::erase(group.parts, *scene.movingPart());
  group.parts.push_back(*scene.movingPart());
  return group;
}

}  // namespace

PoseSubject poseSubjectOf(const Scene& scene, const Selection& selection, const HandState& hand) {
  const std::vector<PartId>& selected = selection.parts();
  const bool isOfGroup = hand.holdsGroup() && areMoving(scene, selected);
  if (isOfGroup || (!selected.empty() && areMovingGroup(scene, selected))) return groupInHand(scene);
  if (selected.empty() && scene.movingGroup()) return groupInHand(scene);
  if (selected.empty() && scene.movingPart()) return {{*scene.movingPart()}};
  PoseSubject subject{selected};
  if (!selected.empty()) {
    const PartId lead = leadOf(scene, selection);
    std::erase(subject.parts, lead);
    subject.parts.push_back(lead);
  }
  return subject;
}

PartId leadOf(const Scene& scene, const Selection& selection) {
  if (areMovingGroup(scene, selection.parts())) return *scene.movingPart();
  const SceneNodes outer = outermost(scene, selection.nodes());
  const bool isOneGroup = outer.parts.empty() && outer.groups.size() == 1;
  return isOneGroup ? leadOfGroup(scene, outer.groups.front()).value_or(selection.parts().back())
                    : selection.parts().back();
}

glm::dvec3 pivotInLead(const Scene& scene, const PoseSubject& subject, const ShownPoses& poses) {
  const Part* lead = subject.lead() ? scene.find(*subject.lead()) : nullptr;
  std::vector<PlacedPart> placed;
  for (const PartId id : subject.parts) {
    const Part* part = scene.find(id);
    if (part != nullptr && part->geometry != nullptr) placed.push_back({part, poses.poseOf(*part)});
  }
  if (lead == nullptr || placed.empty()) return glm::dvec3(0.0);
  const RigidTransform leadFromWorld = poses.poseOf(*lead).inverse();
  if (const std::optional<glm::dvec3> shared = sharedPivot(placed))
    return leadFromWorld.applyToPoint(*shared);
  if (subject.isGroupInHand) return massOfMoving(scene).properties.centre;
  return leadFromWorld.applyToPoint(centreOfMass(placed));
}

}  // namespace nearfit::ui
