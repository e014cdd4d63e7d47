#include "core/report/placement_export.h"

#include <algorithm>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "core/files/atomic_write.h"
#include "core/report/lmd_set.h"
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
  json["metresPerUnit"] = part.geometry->metresPerUnit;
  json["visible"] = part.isVisible;
  json["matrix"] = matrixJson(part.worldFromPart);
  json["position"] = pointJson(part.worldFromPart.translation);
  json["quaternion"] = {q.w, q.x, q.y, q.z};
  return json;
}

Json massJson(const Part& part) {
  const MassProperties& mass = part.geometry->mass;
  return {{"basis", nameOf(mass.basis)},
          {"volume", mass.volume},
          {"centre", pointJson(part.worldFromPart.applyToPoint(mass.centre))}};
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

Json leastDistance(const LmdSet& set) {
  return set.lmds.empty() ? Json() : Json(set.lmds.front().distance);
}

Json clearanceTo(const Part& other, const Part& moving, double cutoff, LmdCollector& collector) {
  const RigidTransform otherFromMoving = other.worldFromPart.inverse() * moving.worldFromPart;
  const NormalConeTree &scene = other.geometry->tree(), &part = moving.geometry->tree();
  LmdSet set = collector.collect(scene, part, otherFromMoving.normalized(), cutoff);
  // The pose between the two does not tell how far from the world's origin both are.
  markFarRegions(
      set.lmds,
      std::max(glm::length(other.worldFromPart.translation), glm::length(moving.worldFromPart.translation)),
      scene.size() + part.size());
  Json json;
  json["part"] = other.name;
  json["distance"] = leastDistance(set);
  json["complete"] = set.isComplete;
  json["lmds"] = Json::array();
  for (const Lmd& lmd : set.lmds)
    json["lmds"].push_back(lmdJson(lmd, other.worldFromPart));
  return json;
}

Json clearanceJson(const Scene& scene, const Part& moving) {
  const double cutoff = scene.haptics().springs.cutoff;
  LmdCollector collector(kMaxLmds);
  Json least, others = Json::array();
  for (const Scene::PartPtr& other : scene.parts()) {
    if (other->id == moving.id || !other->isVisible) continue;
    others.push_back(clearanceTo(*other, moving, cutoff, collector));
    const Json& distance = others.back()["distance"];
    if (!distance.is_null() && (least.is_null() || distance < least)) least = distance;
  }
  return {{"cutoff", cutoff}, {"distance", least}, {"mass", massJson(moving)}, {"to", others}};
}

/// The moving part at its present pose.
Part movedPart(const Part& part, const RigidTransform& worldFromMoving) {
  Part moved = part;
  moved.worldFromPart = checkedPose(worldFromMoving);
  return moved;
}

}  // namespace

std::string placementJson(const Scene& scene, const RigidTransform& worldFromMoving) {
  const Part* held = scene.movingPart() ? scene.find(*scene.movingPart()) : nullptr;
  Json json;
  json["placement"] = kPlacementVersion;
  json["program"] = "Nearfit " NEARFIT_VERSION;
  json["date"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  json["units"] = {{"length", "m"}, {"volume", "m^3"}};
  json["moving"] = held != nullptr ? Json(held->name) : Json();
  json["parts"] = Json::array();
  for (const Scene::PartPtr& part : scene.parts()) {
    json["parts"].push_back(partJson(part.get() == held ? movedPart(*held, worldFromMoving) : *part));
  }
  json["clearance"] = held != nullptr ? clearanceJson(scene, movedPart(*held, worldFromMoving)) : Json();
  return prettyJson(json);
}

void exportPlacement(const Scene& scene, const RigidTransform& worldFromMoving,
                     const std::filesystem::path& file) {
  atomicWrite(file, placementJson(scene, worldFromMoving));
}

}  // namespace nearfit
