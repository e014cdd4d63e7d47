#include "core/scene/scene_json.h"

#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/scene/document_load.h"
#include "core/scene/scene_file.h"
#include "core/text/json_text.h"
#include "core/text/utf8.h"

namespace nearfit {

std::string meshPathFrom(const std::filesystem::path& mesh, const std::filesystem::path& file) {
  std::filesystem::path path = mesh.lexically_relative(meshFolder(file));
  if (path.empty()) path = mesh;
  std::string text = path.generic_string();
  // JSON can escape control characters, but must be UTF-8.
  if (!isUtf8(text)) {
    throw FileError(printableText(text), "the path of this mesh file is not UTF-8",
                    "rename the file or its folder, then load it again");
  }
  return text;
}

std::filesystem::path readMeshPath(const JsonField& field, const std::filesystem::path& folder) {
  const std::string mesh = field.text(kMaxPathBytes);
  if (mesh.empty()) field.fail("it is empty", "give the path of the mesh file");
  return normalisedPath(folder / mesh);
}

nlohmann::ordered_json repairsJson(const MeshRepairs& repairs) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const MeshRepair& repair : repairs)
    json.push_back({{"kind", wordOf(repair.kind)}, {"size", repair.size}});
  return json;
}

nlohmann::ordered_json shapeJson(const PartGeometry& geometry) {
  if (geometry.shapeKey.empty()) return {};
  return {{"key", geometry.shapeKey},
          {"chord", geometry.tessellation.chord},
          {"angle", geometry.tessellation.angle}};
}

MeshRepairs readRepairs(const JsonField& field) {
  if (field.size() > kMaxRepairs) field.fail(fmt::format("there are more than {} repairs", kMaxRepairs));
  MeshRepairs repairs;
  for (std::size_t i = 0; i < field.size(); ++i) {
    const JsonField each = field.at(i), size = each.at("size");
    const std::optional<RepairKind> kind = repairNamed(each.at("kind").text(16));
    if (!kind) {
      each.at("kind").fail(
          "this repair is not known",
          R"(give "weld", "stitch", "clean", "orient", "fillHoles" or "dropShells", or open it with a newer Nearfit)");
    }
    repairs.push_back({*kind, hasSize(*kind) ? size.number() : 0.0});
    checkedAt(size, [&] { checkRepairs(std::span(&repairs.back(), 1)); });
  }
  return repairs;
}

ShapeOfFile readShape(const JsonField& field, const std::filesystem::path& mesh) {
  const bool isDocument = isDocumentFile(mesh);
  if (field.isNull()) {
    if (isDocument) field.fail("the part's file is a CAD document", "name one of its shapes");
    return {};
  }
  if (!isDocument) field.fail("the part's file is not a CAD document", "give null");
  ShapeOfFile shape{field.at("key").text(kMaxShapeKeyBytes)};
  if (shape.key.empty()) field.at("key").fail("it is empty", "name a shape of the document");
  shape.tessellation = {field.at("chord").number(), field.at("angle").number()};
  checkedAt(field, [&] { checkTessellation(shape.tessellation); });
  return shape;
}

nlohmann::ordered_json colourJson(const Colour& colour) {
  return {shortestDouble(colour.r), shortestDouble(colour.g), shortestDouble(colour.b)};
}

void addPose(nlohmann::ordered_json& json, const RigidTransform& pose) {
  const glm::dvec3& t = pose.translation;
  const glm::dquat& q = pose.rotation;
  json["position"] = {t.x, t.y, t.z};
  json["quaternion"] = {q.w, q.x, q.y, q.z};
}

RigidTransform readPose(const JsonField& field) {
  const auto [x, y, z] = readNumbers<3>(field.at("position"));
  const auto [qw, qx, qy, qz] = readNumbers<4>(field.at("quaternion"));
  const RigidTransform translation{{1, 0, 0, 0}, {x, y, z}}, rotation{{qw, qx, qy, qz}, {}};
  checkedAt(field.at("position"), [&] { return checkedPose(translation); });
  return {checkedAt(field.at("quaternion"), [&] { return checkedPose(rotation); }).rotation,
          translation.translation};
}

Colour readColour(const JsonField& field) {
  field.requireSize(3);
  const auto channel = [&](std::size_t i) { return static_cast<float>(field.at(i).numberWithin(0.0, 1.0)); };
  return {channel(0), channel(1), channel(2)};
}

nlohmann::ordered_json pivotJson(const std::optional<glm::dvec3>& pivot) {
  return pivot ? nlohmann::ordered_json({pivot->x, pivot->y, pivot->z}) : nlohmann::ordered_json();
}

std::optional<glm::dvec3> readPivot(const JsonField& field) {
  if (field.isNull()) return std::nullopt;
  const auto [x, y, z] = readNumbers<3>(field);
  const glm::dvec3 pivot(x, y, z);
  checkedAt(field, [&] { checkPosition(pivot); });
  return pivot;
}

nlohmann::ordered_json jointFeatureJson(const JointFeature& feature, JointKind kind) {
  const glm::dvec3 &p = feature.point, &d = feature.direction;
  nlohmann::ordered_json json = {{"point", {p.x, p.y, p.z}}};
  if (kind != JointKind::ToPoint) json["direction"] = {d.x, d.y, d.z};
  return json;
}

JointKind readJointKind(const JsonField& field) {
  const std::optional<JointKind> kind = jointKindOf(field.text(16));
  if (!kind) field.fail("this value is not known", R"(give "axis", "plane" or "point")");
  return *kind;
}

JointFeature readJointFeature(const JsonField& field, JointKind kind) {
  JointFeature feature;
  const auto [x, y, z] = readNumbers<3>(field.at("point"));
  feature.point = {x, y, z};
  checkedAt(field.at("point"), [&] { checkPosition(feature.point); });
  if (kind == JointKind::ToPoint) return feature;
  const auto [dx, dy, dz] = readNumbers<3>(field.at("direction"));
  const glm::dvec3 direction(dx, dy, dz);
  feature.direction = checkedAt(field.at("direction"), [&] { return checkedDirection(direction); });
  return feature;
}

nlohmann::ordered_json pairRulesJson(const std::vector<PairRule>& rules) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const PairRule& rule : rules)
    json.push_back({{"kind", wordOf(rule.kind)},
                    {"part", rule.part},
                    {"other", rule.other},
                    {"interference", rule.interference}});
  return json;
}

std::vector<PairRule> readPairRules(const JsonField& field) {
  const std::size_t count = field.size();
  if (count > kMaxPairRules) field.fail(fmt::format("there are more than {} rules", kMaxPairRules));
  std::vector<PairRule> rules;
  for (std::size_t i = 0; i < count; ++i) {
    const JsonField each = field.at(i);
    const std::optional<PairRuleKind> kind = pairRuleNamed(each.at("kind").text(16));
    if (!kind)
      each.at("kind").fail("this value is not known",
                           R"(give "leaveOut", "sameGroup", "touching" or "pressFit")");
    // Field by field: GCC 12 destroys a member twice where a later initialiser within the braces throws.
    PairRule rule;
    rule.kind = *kind;
    rule.part = each.at("part").text(kMaxPatternBytes);
    rule.other = each.at("other").text(kMaxPatternBytes);
    rule.interference = each.at("interference").number();
    checkedAt(each, [&] { checkPairRule(rule); });
    rules.push_back(std::move(rule));
  }
  return rules;
}

void addFinding(nlohmann::ordered_json& json, const PairRecord& record) {
  json["verdict"] = wordOf(record.verdict);
  json["distance"] = record.distance;
  json["depth"] = record.depth ? nlohmann::ordered_json(*record.depth) : nlohmann::ordered_json();
  json["state"] = wordOf(record.state);
  json["reason"] = record.reason;
}

FindingState readFindingState(const JsonField& field) {
  const std::optional<FindingState> state = findingStateNamed(field.text(16));
  if (!state) field.fail("this value is not known", R"(give "new", "accepted" or "fixed")");
  return *state;
}

PairRecord readFinding(const JsonField& field) {
  PairRecord record;
  const std::optional<PairVerdict> verdict = pairVerdictNamed(field.at("verdict").text(16));
  if (!verdict)
    field.at("verdict").fail("this value is not known",
                             R"(give "clear", "near", "touching", "clash" or "contained")");
  record.verdict = *verdict;
  record.state = readFindingState(field.at("state"));
  record.distance = field.at("distance").number();
  if (!field.at("depth").isNull()) record.depth = field.at("depth").number();
  record.reason = field.at("reason").text(kMaxReasonBytes);
  PairRecord ordered = record;
  ordered.pair = {PartId{0}, PartId{1}};
  checkedAt(field, [&] { checkPairRecord(ordered); });
  return record;
}

}  // namespace nearfit
