#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/files/atomic_write.h"
#include "core/scene/scene_file.h"
#include "core/scene/scene_file_haptics.h"
#include "core/scene/scene_json.h"
#include "core/scene/scene_tree.h"
#include "core/text/json_text.h"

namespace nearfit {
namespace {

using Json = nlohmann::ordered_json;

/// Index of each group in the file.
using GroupIndices = std::map<GroupId, std::size_t>;
/// Index of each part in the file.
using PartIndices = std::map<PartId, std::size_t>;

Json indexJson(std::optional<GroupId> group, const GroupIndices& indices) {
  return group ? Json(indices.at(*group)) : Json();
}

/// Says which groups are older where the file's order, parents first, does not.
void addAges(const Scene& scene, const GroupIndices& indices, Json& json) {
  std::vector<std::size_t> places;
  for (const Scene::GroupPtr& group : scene.groups())
    places.push_back(indices.at(group->id));
  if (std::ranges::is_sorted(places)) return;
  for (std::size_t age = 0; age < places.size(); ++age)
    json[places[age]]["age"] = age;
}

Json groupsJson(const Scene& scene, GroupIndices& indices) {
  Json json = Json::array();
  visitGroups(scene, [&](const Group& group, std::size_t) {
    indices.emplace(group.id, indices.size());
    json.push_back(
        {{"name", group.name}, {"group", indexJson(group.parent, indices)}, {"locked", group.isLocked}});
  });
  addAges(scene, indices, json);
  return json;
}

Json partJson(const Part& part, const GroupIndices& groups, const std::filesystem::path& sceneFile) {
  Json json;
  json["name"] = part.name;
  json["mesh"] = meshPathFrom(part.geometry->file, sceneFile);
  json["sha256"] = part.geometry->sha256;
  json["metresPerUnit"] = part.geometry->metresPerUnit;
  json["shape"] = shapeJson(*part.geometry);
  json["repairs"] = repairsJson(part.geometry->repairs);
  addPose(json, part.worldFromPart);
  json["colour"] = colourJson(part.colour);
  json["density"] = part.density;
  json["opacity"] = part.opacity;
  json["pivot"] = pivotJson(part.pivot);
  json["visible"] = part.isVisible;
  json["locked"] = part.isLocked;
  json["group"] = indexJson(part.group, groups);
  json["wasVisible"] = part.wasVisible ? Json(*part.wasVisible) : Json();
  return json;
}

Json jointJson(const Joint& joint, const Scene& scene) {
  Json json;
  json["kind"] = wordOf(joint.kind);
  json["part"] = scene.get(joint.part).name;
  json["base"] = joint.base ? Json(scene.get(*joint.base).name) : Json();
  json["onPart"] = jointFeatureJson(joint.onPart, joint.kind);
  json["onBase"] = jointFeatureJson(joint.onBase, joint.kind);
  json["on"] = joint.isOn;
  return json;
}

Json pairRecordJson(const PairRecord& record, const PartIndices& indices) {
  Json json;
  json["part"] = indices.at(record.pair.part);
  json["other"] = indices.at(record.pair.other);
  addFinding(json, record);
  return json;
}

}  // namespace

std::string sceneFileText(const Scene& scene, const std::filesystem::path& file) {
  Json json;
  json["nearfit"] = kSceneFileVersion;
  json["units"] = {{"length", "m"}, {"force", "N"}, {"time", "s"}};
  json["haptics"] = hapticsJson(scene.haptics());
  const bool isPartInHand = scene.movingPart() && !scene.movingGroup();
  json["moving"] = isPartInHand ? Json(scene.find(*scene.movingPart())->name) : Json();
  GroupIndices groups;
  Json listed = groupsJson(scene, groups);
  json["movingGroup"] = indexJson(scene.movingGroup(), groups);
  json["groups"] = std::move(listed);
  json["parts"] = Json::array();
  PartIndices parts;
  for (const Scene::PartPtr& part : scene.parts()) {
    parts.emplace(part->id, parts.size());
    json["parts"].push_back(partJson(*part, groups, file));
  }
  json["joints"] = Json::array();
  for (const Joint& joint : scene.joints())
    json["joints"].push_back(jointJson(joint, scene));
  json["pairRules"] = pairRulesJson(scene.pairRules());
  json["pairRecords"] = Json::array();
  for (const PairRecord& record : scene.pairRecords())
    json["pairRecords"].push_back(pairRecordJson(record, parts));
  return prettyJson(json);
}

void writeSceneFile(const Scene& scene, const std::filesystem::path& file) {
  atomicWrite(file, sceneFileText(scene, file));
}

}  // namespace nearfit
