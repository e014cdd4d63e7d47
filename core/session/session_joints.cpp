// Commands about joints.
#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"
#include "core/session/session.h"
#include "core/session/session_labels.h"

namespace nearfit {
namespace {

const char* phraseOf(JointKind kind) {
  switch (kind) {
    case JointKind::OnAxis:
      return "on axis";
    case JointKind::InPlane:
      return "in plane";
    case JointKind::ToPoint:
      break;
  }
  return "to point";
}

/// "joint of Peg", "2 joints of Peg", "3 joints of 2 parts".
std::string nameOfJoints(const Scene& scene, const std::vector<JointId>& ids) {
  SceneNodes parts;
  for (const JointId id : ids) {
    const PartId part = scene.getJoint(id).part;
    if (std::ranges::find(parts.parts, part) == parts.parts.end()) parts.parts.push_back(part);
  }
  const std::string of = " of " + nameOf(scene, parts);
  return (ids.size() == 1 ? std::string("joint") : fmt::format("{} joints", ids.size())) + of;
}

/// The IDs, each once. Throws UsageError if a joint is unknown or its part is locked.
std::vector<JointId> changeableJoints(const Scene& scene, std::vector<JointId> ids) {
  for (const JointId id : ids)
    scene.requireUnlocked(scene.get(scene.getJoint(id).part));
  std::ranges::sort(ids);
  const auto repeated = std::ranges::unique(ids);
  ids.erase(repeated.begin(), repeated.end());
  return ids;
}

}  // namespace

JointId Session::addJoint(const Joint& joint, const RigidTransform& worldFromPart) {
  Scene next = scene();
  const JointId id = next.addJoint(joint);
  Part part = next.get(joint.part);
  const RigidTransform from = part.worldFromPart, to = checkedPose(worldFromPart);
  const glm::dvec3 centre = part.geometry != nullptr ? part.geometry->mass.centre : glm::dvec3(0.0);
  Step step{fmt::format("Keep {} {}", part.name, phraseOf(joint.kind)),
            glm::distance(from.applyToPoint(centre), to.applyToPoint(centre)),
            glm::length(rotationVector(to.rotation * glm::conjugate(from.rotation)))};
  part.worldFromPart = to;
  next.replace(std::move(part));
  commit(std::move(next), std::move(step), steps::AddJoint{joint, worldFromPart});
  return id;
}

void Session::removeJoints(const std::vector<JointId>& ids) {
  const std::vector<JointId> removed = changeableJoints(scene(), ids);
  if (removed.empty()) return;
  Scene next = scene();
  for (const JointId id : removed)
    next.removeJoint(id);
  commit(std::move(next), "Remove " + nameOfJoints(scene(), removed), steps::RemoveJoints{removed});
}

void Session::setJointsOn(const std::vector<JointId>& ids, bool on) {
  Scene next = scene();
  std::vector<JointId> changed;
  for (const JointId id : changeableJoints(scene(), ids)) {
    Joint joint = next.getJoint(id);
    if (std::exchange(joint.isOn, on) == on) continue;
    next.replaceJoint(joint);
    changed.push_back(id);
  }
  if (changed.empty()) return;
  commit(std::move(next), (on ? "Turn on " : "Turn off ") + nameOfJoints(scene(), changed),
         steps::SetJointsOn{changed, on});
}

}  // namespace nearfit
