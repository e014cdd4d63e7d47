#include "app/cli/scene_part.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/name_pattern.h"

namespace nearfit::cli {

PartId chosenPart(const Scene& scene, const std::string& name) {
  if (name.empty()) {
    if (scene.movingGroup())
      throw UsageError("--part", "a group is in hand, not a part", "name one of the scene's parts");
    if (scene.movingPart()) return *scene.movingPart();
    throw UsageError("--part", "the scene has no moving part", "name one of its parts");
  }
  const Part* part = scene.findByName(name);
  if (part == nullptr)
    throw UsageError("--part", fmt::format("there is no part \"{}\"", name), "name a part of the scene");
  return part->id;
}

GroupId namedGroup(const Scene& scene, const std::string& name, const std::string& sceneFile) {
  const auto hasName = [&](const Scene::GroupPtr& group) { return group->name == name; };
  const auto count = std::ranges::count_if(scene.groups(), hasName);
  if (count == 1) return (*std::ranges::find_if(scene.groups(), hasName))->id;
  if (count == 0) {
    throw UsageError(sceneFile, "there is no group \"" + name + "\"",
                     "name a group of the scene (nearfit shows them)");
  }
  throw UsageError(sceneFile, fmt::format("{} groups are named \"{}\"", count, name),
                   "rename the one that is meant");
}

Scene withInHand(Scene scene, const std::string& part, const std::string& group,
                 const std::string& sceneFile) {
  if (!part.empty() && !group.empty())
    throw UsageError("--group", "either a part or a group moves", "leave out --part or --group");
  if (!group.empty()) scene.setMovingGroup(namedGroup(scene, group, sceneFile));
  if (!part.empty()) scene.setMovingPart(chosenPart(scene, part));
  if (!scene.movingPart())
    throw UsageError("--part", "the scene has nothing in hand", "name the part or the group that moves");
  return scene;
}

bool isNameOfPart(const Scene& scene, const std::string& pattern) {
  return std::ranges::any_of(
      scene.parts(), [&pattern](const Scene::PartPtr& part) { return matchesPattern(pattern, part->name); });
}

}  // namespace nearfit::cli
