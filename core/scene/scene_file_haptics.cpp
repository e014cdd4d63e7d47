#include "core/scene/scene_file_haptics.h"

#include <array>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/scene/haptic_limits.h"

namespace nearfit {
namespace {

using Json = nlohmann::ordered_json;

/// True if the field holds the first word, false for the second; fails for any other.
bool isFirstOf(const JsonField& field, const char* first, const char* second) {
  const std::string word = field.text(16);
  if (word != first && word != second) {
    field.fail("this value is not known", std::string("give \"") + first + "\" or \"" + second + "\"");
  }
  return word == first;
}

template <std::size_t Count, typename Read>
auto readArray(const JsonField& field, Read read) {
  field.requireSize(Count);
  std::array<decltype(read(field)), Count> values{};
  for (std::size_t i = 0; i < Count; ++i)
    values[i] = read(field.at(i));
  return values;
}

double number(const JsonField& field) {
  return field.number();
}

bool flag(const JsonField& field) {
  return field.isTrue();
}

SpringParameters readSprings(const JsonField& field) {
  SpringParameters springs;
  springs.cutoff = field.at("cutoff").number();
  springs.stiffness = field.at("stiffness").number();
  springs.damping = field.at("damping").number();
  springs.law = isFirstOf(field.at("law"), "linear", "printed") ? SpringLaw::Linear : SpringLaw::Printed;
  if (field.has("onePerArea")) springs.onePerArea = field.at("onePerArea").isTrue();
  return springs;
}

CouplingSettings readCoupling(const JsonField& field) {
  CouplingSettings coupling;
  coupling.isAutomatic = field.at("automatic").isTrue();
  coupling.stiffness = field.at("stiffness").number();
  coupling.damping = field.at("damping").number();
  coupling.rotationalStiffness = field.at("rotationalStiffness").number();
  coupling.rotationalDamping = field.at("rotationalDamping").number();
  return coupling;
}

WeightSettings readWeight(const JsonField& field) {
  const auto [x, y, z] = readArray<3>(field.at("gravity"), number);
  return {field.at("weight").isTrue(), field.at("inertia").isTrue(), {x, y, z}};
}

WorkspaceMapping readMapping(const JsonField& field) {
  const auto [w, x, y, z] = readArray<4>(field.at("orientation"), number);
  return {field.at("scale").number(),
          {w, x, y, z},
          readArray<3>(field.at("translationLocks"), flag),
          readArray<3>(field.at("rotationLocks"), flag)};
}

/// The field that a path such as "springs.cutoff" leads to, from `field`.
JsonField fieldAt(JsonField field, std::string_view path) {
  for (std::size_t dot; (dot = path.find('.')) != std::string_view::npos; path.remove_prefix(dot + 1))
    field = field.at(std::string(path.substr(0, dot)));
  return field.at(std::string(path));
}

/// @param field  Holds the sections under the names that checkHaptics() uses.
HapticSettings checked(const JsonField& field, const HapticSettings& settings) {
  try {
    checkHaptics(settings);
  } catch (const UsageError& e) {
    fieldAt(field, e.where()).fail(e.problem(), e.remedy());
  }
  return settings;
}

Json springsJson(const SpringParameters& springs) {
  Json json{{"cutoff", springs.cutoff},
            {"stiffness", springs.stiffness},
            {"damping", springs.damping},
            {"law", springs.law == SpringLaw::Printed ? "printed" : "linear"}};
  // Without it the file is as former programs write it.
  if (springs.onePerArea) json["onePerArea"] = true;
  return json;
}

Json couplingJson(const CouplingSettings& coupling) {
  return {{"automatic", coupling.isAutomatic},
          {"stiffness", coupling.stiffness},
          {"damping", coupling.damping},
          {"rotationalStiffness", coupling.rotationalStiffness},
          {"rotationalDamping", coupling.rotationalDamping}};
}

Json weightJson(const WeightSettings& weight) {
  const glm::dvec3& g = weight.gravity;
  return {{"weight", weight.hasWeight}, {"inertia", weight.hasInertia}, {"gravity", {g.x, g.y, g.z}}};
}

Json mappingJson(const WorkspaceMapping& mapping) {
  const glm::dquat& q = mapping.orientationOffset;
  return {{"scale", mapping.scale},
          {"orientation", {q.w, q.x, q.y, q.z}},
          {"translationLocks", mapping.translationLocks},
          {"rotationLocks", mapping.rotationLocks}};
}

}  // namespace

Json hapticsJson(const HapticSettings& settings) {
  return {{"mode", settings.mode == HapticMode::Proxy ? "proxy" : "springs"},
          {"springs", springsJson(settings.springs)},
          {"proxy", {{"margin", settings.proxy.margin}, {"friction", settings.proxy.friction}}},
          {"coupling", couplingJson(settings.coupling)},
          {"weight", weightJson(settings.weight)},
          {"mapping", mappingJson(settings.mapping)}};
}

HapticSettings readHaptics(const JsonField& field) {
  HapticSettings settings;
  settings.mode = isFirstOf(field.at("mode"), "proxy", "springs") ? HapticMode::Proxy : HapticMode::Springs;
  settings.springs = readSprings(field.at("springs"));
  settings.proxy = {field.at("proxy").at("margin").number(), field.at("proxy").at("friction").number()};
  settings.coupling = readCoupling(field.at("coupling"));
  settings.weight = readWeight(field.at("weight"));
  settings.mapping = readMapping(field.at("mapping"));
  return checked(field, settings);
}

HapticSettings readHapticsOfVersion1(const JsonField& root) {
  HapticSettings settings;
  settings.springs = readSprings(root.at("springs"));
  settings.proxy.margin = defaultMargin(settings.springs.cutoff);
  return checked(root, settings);
}

}  // namespace nearfit
