#include "app/cli/joints_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/output.h"
#include "core/scene/joint_set.h"

namespace nearfit::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string baseOf(const Scene& scene, const Joint& joint) {
  return joint.base ? scene.get(*joint.base).name : "the world";
}

std::string keptText(const Scene& scene, const Part& part) {
  const JointSet joints = jointsOf(scene, part.id);
  if (joints.isEmpty()) return {};
  const JointResidual off = joints.residual(part.worldFromPart);
  const char* fit = joints.isContradictory() ? "; they contradict each other, so that none holds" : "";
  return fmt::format("  kept        {}: {:.3g} m and {:.3g} rad off its joints{}\n", oneLine(part.name),
                     off.distance, off.angle, fit);
}

}  // namespace

std::string jointText(const Scene& scene, const Joint& joint) {
  return oneLine(fmt::format("{} {} {} of {}, {}", scene.get(joint.part).name,
                             joint.kind == JointKind::OnAxis    ? "on"
                             : joint.kind == JointKind::InPlane ? "in"
                                                                : "to",
                             wordOf(joint.kind), baseOf(scene, joint), joint.isOn ? "on" : "off"));
}

std::string jointsText(const Scene& scene) {
  std::string text;
  for (std::size_t i = 0; i < scene.joints().size(); ++i)
    text += fmt::format("  joint {:<5} {}\n", i + 1, jointText(scene, scene.joints()[i]));
  for (const Scene::PartPtr& part : scene.parts())
    text += keptText(scene, *part);
  return text;
}

Json jointsJson(const Scene& scene) {
  Json all = Json::array();
  for (const Joint& joint : scene.joints()) {
    const Part& part = scene.get(joint.part);
    const JointSet joints = jointsOf(scene, part.id);
    const JointResidual off = joints.residual(part.worldFromPart);
    Json json;
    json["kind"] = wordOf(joint.kind);
    json["part"] = part.name;
    json["base"] = joint.base ? Json(scene.get(*joint.base).name) : Json();
    json["on"] = joint.isOn;
    // Distance and angle over all joints of the part that are on.
    json["off"] = {{"distance", off.distance}, {"angle", off.angle}};
    json["contradictory"] = joints.isContradictory();
    all.push_back(std::move(json));
  }
  return all;
}

}  // namespace nearfit::cli
