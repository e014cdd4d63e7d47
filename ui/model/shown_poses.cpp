#include "ui/model/shown_poses.h"

#include <algorithm>
#include <utility>

namespace nearfit::ui {

ShownPoses::ShownPoses(Session& session, QObject* parent)
    : QObject(parent), session_(session), sceneSerial_(session.sceneSerial()) {
  changes_ = session_.onChange(SceneEvents::Stage::Model, [this] { followSession(); });
}

void ShownPoses::show(Source source, Poses worldFromPart) {
  Poses& poses = poses_.at(static_cast<std::size_t>(source));
  const Poses before = std::exchange(poses, std::move(worldFromPart));
  std::vector<PartId> parts;
  for (const auto& [part, pose] : before)
    if (!poses.contains(part)) parts.push_back(part);
  for (const auto& [part, pose] : poses) {
    const auto was = before.find(part);
    if (was == before.end() || was->second.rotation != pose.rotation ||
        was->second.translation != pose.translation)
      parts.push_back(part);
  }
  if (!parts.empty()) emit changed(parts);
}

RigidTransform ShownPoses::poseOfMoving() const {
  const Part* part = session_.scene().find(session_.scene().movingPart().value_or(PartId{}));
  return part != nullptr ? poseOf(*part) : RigidTransform{};
}

RigidTransform ShownPoses::poseFrom(Source first, const Part& part) const {
  for (auto source = static_cast<std::size_t>(first); source < poses_.size(); ++source) {
    const auto found = poses_[source].find(part.id);
    if (found != poses_[source].end()) return found->second;
  }
  return part.worldFromPart;
}

void ShownPoses::followSession() {
  // In another scene the same ids mean other parts.
  if (std::exchange(sceneSerial_, session_.sceneSerial()) != session_.sceneSerial()) {
    for (const Source source : {Source::Preview, Source::Drag, Source::Replay, Source::Hand})
      show(source, {});
  }
  for (const Source source : {Source::Replay, Source::Hand}) {
    const auto isLeft = [this](const auto& entry) { return !session_.scene().isMoving(entry.first); };
    if (std::ranges::any_of(posesOf(source), isLeft)) show(source, {});
  }
}

}  // namespace nearfit::ui
