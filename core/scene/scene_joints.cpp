// Joints of a scene.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace nearfit {

const Joint* Scene::findJoint(JointId id) const noexcept {
  const auto it = std::ranges::lower_bound(joints_, id, {}, &Joint::id);
  return it == joints_.end() || it->id != id ? nullptr : &*it;
}

const Joint& Scene::getJoint(JointId id) const {
  return joints_[indexOf(id)];
}

std::size_t Scene::indexOf(JointId id) const {
  const auto it = std::ranges::lower_bound(joints_, id, {}, &Joint::id);
  if (it == joints_.end() || it->id != id) {
    throw UsageError(fmt::format("joint {}", static_cast<std::uint32_t>(id)), "the scene has no such joint",
                     "choose one that is in the scene");
  }
  return static_cast<std::size_t>(it - joints_.begin());
}

Joint Scene::checkedForScene(const Joint& joint) const {
  const Part& part = get(joint.part);
  const std::string where = fmt::format("joint of \"{}\"", part.name);
  if (joint.base == joint.part)
    throw UsageError(where, "a part cannot be kept on itself",
                     "choose a feature of another part as its base");
  if (joint.base) get(*joint.base);
  requireUnlocked(part);
  Joint checked = checkedJoint(joint);
  const auto others = std::ranges::count_if(
      joints_, [&](const Joint& other) { return other.part == joint.part && other.id != joint.id; });
  if (static_cast<std::size_t>(others) >= kMaxJointsPerPart) {
    throw UsageError(where, fmt::format("the part has {} joints already", kMaxJointsPerPart),
                     "remove one of them first");
  }
  return checked;
}

JointId Scene::addJoint(Joint joint) {
  joint.id = JointId{nextJointId_};
  joint = checkedForScene(joint);
  if (joints_.size() >= kMaxJoints) {
    throw UsageError(fmt::format("joint of \"{}\"", get(joint.part).name),
                     fmt::format("the scene has {} joints already", kMaxJoints), "remove some first");
  }
  joints_.push_back(joint);
  return JointId{nextJointId_++};
}

void Scene::replaceJoint(Joint joint) {
  const std::size_t index = indexOf(joint.id);
  requireUnlocked(get(joints_[index].part));
  joints_[index] = checkedForScene(joint);
}

void Scene::removeJoint(JointId id) {
  const std::size_t index = indexOf(id);
  requireUnlocked(get(joints_[index].part));
  joints_.erase(joints_.begin() + static_cast<std::ptrdiff_t>(index));
}

void Scene::scaleJointsOn(PartId part, double factor) {
  std::vector<Joint> scaled = joints_;
  const auto scale = [factor](JointFeature& feature) {
    feature.point *= factor;
    checkPosition(feature.point);
  };
  for (Joint& joint : scaled) {
    if (joint.part == part) scale(joint.onPart);
    if (joint.base == part) scale(joint.onBase);
  }
  joints_ = std::move(scaled);
}

void Scene::scaleWorldJointsOf(PartId part, double factor) {
  std::vector<Joint> scaled = joints_;
  for (Joint& joint : scaled) {
    if (joint.part != part || joint.base) continue;
    joint.onBase.point *= factor;
    checkPosition(joint.onBase.point);
  }
  joints_ = std::move(scaled);
}

}  // namespace nearfit
