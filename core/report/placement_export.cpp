#include "core/report/placement_export.h"

#include <algorithm>
#include <ctime>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "core/files/atomic_write.h"
#include "core/proximity/tracking/lmd_set.h"
#include "core/report/mesh_export.h"
#include "core/scene/moving_body.h"
#include "core/text/json_text.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPlacementVersion = 1;
/// Max minima to each other part: keeps the file within some 10 MB per part if the cutoff is wrong.
constexpr std::size_t kMaxLmds = 50'000;

Json pointJson(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

Json matrixJson(const RigidTransform& worldFromPart) {
  const glm::dmat4 m = worldFromPart.toMatrix();
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back({m[0][row], m[1][row], m[2][row], m[3][row]});
  return rows;
}

Json partJson(const Part& part) {
  const std::string mesh = part.geometry->file.string();
  const glm::dquat& q = part.worldFromPart.rotation;
  Json json;
  json["name"] = part.name;
  json["mesh"] = isUtf8(mesh) ? mesh : printableText(mesh);
  json["sha256"] = part.geometry->sha256;
  if (!part.geometry->shapeKey.empty()) json["shape"] = part.geometry->shapeKey;
  json["metresPerUnit"] = part.geometry->metresPerUnit;
  json["visible"] = part.isVisible;
  json["matrix"] = matrixJson(part.worldFromPart);
  json["position"] = pointJson(part.worldFromPart.translation);
  json["quaternion"] = {q.w, q.x, q.y, q.z};
  return json;
}

Json massJson(const Scene& scene) {
  const MassProperties mass = massOfMoving(scene).properties;
  const RigidTransform& worldFromMoving = scene.get(*scene.movingPart()).worldFromPart;
  return {{"basis", nameOf(mass.basis)},
          {"volume", mass.volume},
          {"centre", pointJson(worldFromMoving.applyToPoint(mass.centre))}};
}

Json lmdJson(const Lmd& lmd, const RigidTransform& worldFromOther) {
  const Lmd inWorld = transformed(lmd, worldFromOther);
  Json json = {{"distance", lmd.distance},
               {"moving", pointJson(inWorld.partPoint)},
               {"other", pointJson(inWorld.scenePoint)},
               {"features", {nameOf(lmd.partFeature), nameOf(lmd.sceneFeature)}},
               {"region", lmd.isRegion},
               {"blocked", lmd.isBlocked},
               {"marginal", lmd.isMarginal}};
  if (lmd.isRegion) {
    json["extent"] = {{"dimension", lmd.extent.dimension},
                      {"measure", lmd.extent.measure},
                      {"axis", pointJson(inWorld.extent.axis)},
                      {"half", {lmd.extent.halfLength, lmd.extent.halfWidth}}};
  }
  return json;
}

/// The parts of a moving group whose minima count: the visible ones. Of a part alone that part, seen or not.
std::vector<const Part*> movingParts(const Scene& scene) {
  std::vector<const Part*> parts;
  for (const PartId id : scene.movingParts()) {
    const Part& part = scene.get(id);
    if (part.isVisible || !scene.movingGroup()) parts.push_back(&part);
  }
  return parts;
}

Json clearanceTo(const Part& other, const std::vector<const Part*>& moving, bool isGroup, double cutoff,
                 LmdCollector& collector) {
  Json json;
  std::vector<std::pair<Lmd, const Part*>> found;
  bool isComplete = true;
  for (const Part* part : moving) {
    const RigidTransform otherFromPart = other.worldFromPart.inverse() * part->worldFromPart;
    const NormalConeTree &otherTree = other.geometry->tree(), &partTree = part->geometry->tree();
    LmdSet set = collector.collect(otherTree, partTree, otherFromPart.normalized(), cutoff);
    // The pose between the two does not tell how far from the world's origin both are.
    markFarRegions(
        set.lmds,
        std::max(glm::length(other.worldFromPart.translation), glm::length(part->worldFromPart.translation)),
        otherTree.size() + partTree.size());
    isComplete = isComplete && set.isComplete;
    for (const Lmd& lmd : set.lmds)
      found.emplace_back(lmd, part);
  }
  std::ranges::stable_sort(found, {}, [](const auto& entry) { return entry.first.distance; });
  json["part"] = other.name;
  json["distance"] = found.empty() ? Json() : Json(found.front().first.distance);
  json["complete"] = isComplete;
  json["lmds"] = Json::array();
  for (const auto& [lmd, part] : found) {
    json["lmds"].push_back(lmdJson(lmd, other.worldFromPart));
    if (isGroup) json["lmds"].back()["part"] = part->name;
  }
  return json;
}

Json clearanceJson(const Scene& scene) {
  const double cutoff = scene.haptics().springs.cutoff;
  const std::vector<const Part*> moving = movingParts(scene);
  LmdCollector collector(kMaxLmds);
  Json least, others = Json::array();
  for (const Scene::PartPtr& other : scene.parts()) {
    if (scene.isMoving(other->id) || !other->isVisible) continue;
    others.push_back(clearanceTo(*other, moving, scene.movingGroup().has_value(), cutoff, collector));
    const Json& distance = others.back()["distance"];
    if (!distance.is_null() && (least.is_null() || distance < least)) least = distance;
  }
  return {{"cutoff", cutoff}, {"distance", least}, {"mass", massJson(scene)}, {"to", others}};
}

Json groupJson(const Scene& scene) {
  if (!scene.movingGroup()) return {};
  Json names = Json::array();
  for (const PartId id : scene.movingParts())
    names.push_back(scene.get(id).name);
  return {{"name", scene.findGroup(*scene.movingGroup())->name}, {"parts", names}};
}

}  // namespace

std::string placementJson(const Scene& scene, const RigidTransform& worldFromMoving) {
  const Scene placed = placedScene(scene, worldFromMoving);
  const Part* held = placed.movingPart() ? placed.find(*placed.movingPart()) : nullptr;
  Json json;
  json["placement"] = kPlacementVersion;
  json["program"] = "Nearfit " NEARFIT_VERSION;
  json["date"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  json["units"] = {{"length", "m"}, {"volume", "m^3"}};
  json["moving"] = held != nullptr ? Json(held->name) : Json();
  json["movingGroup"] = groupJson(placed);
  json["parts"] = Json::array();
  for (const Scene::PartPtr& part : placed.parts())
    json["parts"].push_back(partJson(*part));
  json["clearance"] = held != nullptr ? clearanceJson(placed) : Json();
  return prettyJson(json);
}

void exportPlacement(const Scene& scene, const RigidTransform& worldFromMoving,
                     const std::filesystem::path& file) {
  atomicWrite(file, placementJson(scene, worldFromMoving));
}

}  // namespace nearfit
