#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/scene/scene_file.h"
#include "core/scene/scene_file_haptics.h"
#include "core/scene/scene_tree.h"
#include "core/text/json_text.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

using Json = nlohmann::ordered_json;

/// Path of the mesh relative to the scene file's folder, with `/` between names.
std::string meshPath(const std::filesystem::path& mesh, const std::filesystem::path& sceneFile) {
  std::filesystem::path path = mesh.lexically_relative(meshFolder(sceneFile));
  if (path.empty()) path = mesh;
  std::string text = path.generic_string();
  // JSON can escape control characters, but must be UTF-8.
  if (!isUtf8(text)) {
    throw FileError(printableText(text), "the path of this mesh file is not UTF-8",
                    "rename the file or its folder, then load it again");
  }
  return text;
}

/// Index of each group in the file.
using GroupIndices = std::map<GroupId, std::size_t>;
/// Index of each part in the file.
using PartIndices = std::map<PartId, std::size_t>;

Json indexJson(std::optional<GroupId> group, const GroupIndices& indices) {
  return group ? Json(indices.at(*group)) : Json();
}

Json groupsJson(const Scene& scene, GroupIndices& indices) {
  Json json = Json::array();
  visitGroups(scene, [&](const Group& group, std::size_t) {
    indices.emplace(group.id, indices.size());
    json.push_back(
        {{"name", group.name}, {"group", indexJson(group.parent, indices)}, {"locked", group.isLocked}});
  });
  return json;
}

Json repairsJson(const MeshRepairs& repairs) {
  Json json = Json::array();
  for (const MeshRepair& repair : repairs)
    json.push_back({{"kind", wordOf(repair.kind)}, {"size", repair.size}});
  return json;
}

/// Null for a mesh file.
Json shapeJson(const PartGeometry& geometry) {
  if (geometry.shapeKey.empty()) return {};
  return {{"key", geometry.shapeKey},
          {"chord", geometry.tessellation.chord},
          {"angle", geometry.tessellation.angle}};
}

Json partJson(const Part& part, const GroupIndices& groups, const std::filesystem::path& sceneFile) {
  const glm::dvec3& t = part.worldFromPart.translation;
  const glm::dquat& q = part.worldFromPart.rotation;
  Json json;
  json["name"] = part.name;
  json["mesh"] = meshPath(part.geometry->file, sceneFile);
  json["sha256"] = part.geometry->sha256;
  json["metresPerUnit"] = part.geometry->metresPerUnit;
  json["shape"] = shapeJson(*part.geometry);
  json["repairs"] = repairsJson(part.geometry->repairs);
  json["position"] = {t.x, t.y, t.z};
  json["quaternion"] = {q.w, q.x, q.y, q.z};
  json["colour"] = {shortestDouble(part.colour.r), shortestDouble(part.colour.g),
                    shortestDouble(part.colour.b)};
  json["density"] = part.density;
  json["opacity"] = part.opacity;
  json["pivot"] = part.pivot ? Json({part.pivot->x, part.pivot->y, part.pivot->z}) : Json();
  json["visible"] = part.isVisible;
  json["locked"] = part.isLocked;
  json["group"] = indexJson(part.group, groups);
  json["wasVisible"] = part.wasVisible ? Json(*part.wasVisible) : Json();
  return json;
}

Json featureJson(const JointFeature& feature, JointKind kind) {
  const glm::dvec3 &p = feature.point, &d = feature.direction;
  Json json = {{"point", {p.x, p.y, p.z}}};
  if (kind != JointKind::ToPoint) json["direction"] = {d.x, d.y, d.z};
  return json;
}

Json jointJson(const Joint& joint, const Scene& scene) {
  Json json;
  json["kind"] = wordOf(joint.kind);
  json["part"] = scene.get(joint.part).name;
  json["base"] = joint.base ? Json(scene.get(*joint.base).name) : Json();
  json["onPart"] = featureJson(joint.onPart, joint.kind);
  json["onBase"] = featureJson(joint.onBase, joint.kind);
  json["on"] = joint.isOn;
  return json;
}

Json pairRuleJson(const PairRule& rule) {
  return {{"kind", wordOf(rule.kind)},
          {"part", rule.part},
          {"other", rule.other},
          {"interference", rule.interference}};
}

Json pairRecordJson(const PairRecord& record, const PartIndices& indices) {
  Json json;
  json["part"] = indices.at(record.pair.part);
  json["other"] = indices.at(record.pair.other);
  json["verdict"] = wordOf(record.verdict);
  json["distance"] = record.distance;
  json["depth"] = record.depth ? Json(*record.depth) : Json();
  json["state"] = wordOf(record.state);
  json["reason"] = record.reason;
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
  json["pairRules"] = Json::array();
  for (const PairRule& rule : scene.pairRules())
    json["pairRules"].push_back(pairRuleJson(rule));
  json["pairRecords"] = Json::array();
  for (const PairRecord& record : scene.pairRecords())
    json["pairRecords"].push_back(pairRecordJson(record, parts));
  return prettyJson(json);
}

void writeSceneFile(const Scene& scene, const std::filesystem::path& file) {
  atomicWrite(file, sceneFileText(scene, file));
}

}  // namespace nearfit
