#include "app/cli/scene_joints_command.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "app/cli/joints_text.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct KeepOptions {
  std::string scene, part, kind, feature, base;
};

struct ReleaseOptions {
  std::string scene;
  std::vector<std::size_t> numbers;
};

const Part& namedPart(const Scene& scene, const char* where, const std::string& name) {
  const Part* part = scene.findByName(name);
  if (part == nullptr)
    throw UsageError(where, fmt::format("there is no part \"{}\"", name), "name a part of the scene");
  return *part;
}

JointKind parseJointKind(const std::string& word) {
  const std::optional<JointKind> kind = jointKindOf(word);
  if (!kind)
    throw UsageError("KIND", fmt::format("\"{}\" is not a kind of joint", word), "give axis, plane or point");
  return *kind;
}

JointFeature parseJointFeature(const std::string& text, JointKind kind) {
  JointFeature feature;
  if (kind == JointKind::ToPoint) {
    const auto [x, y, z] = parseNumbers<3>("--at", text);
    feature.point = {x, y, z};
    return feature;
  }
  const auto [x, y, z, dx, dy, dz] = parseNumbers<6>("--at", text);
  feature.point = {x, y, z};
  feature.direction = checkedDirection({dx, dy, dz});
  return feature;
}

/// The feature in the frame of something that has this pose.
JointFeature inFrame(const JointFeature& worldFeature, const RigidTransform& worldFromFrame) {
  const RigidTransform frameFromWorld = worldFromFrame.inverse();
  return {frameFromWorld.applyToPoint(worldFeature.point),
          frameFromWorld.applyToVector(worldFeature.direction)};
}

void runSceneKeep(const KeepOptions& options) {
  Joint joint;
  joint.kind = parseJointKind(options.kind);
  const JointFeature feature = parseJointFeature(options.feature, joint.kind);
  Scene scene = readSceneFile(options.scene);
  const Part& part = namedPart(scene, "PART", options.part);
  joint.part = part.id;
  joint.onPart = inFrame(feature, part.worldFromPart);
  joint.onBase = feature;
  // The base's face looks at the part's.
  if (joint.kind == JointKind::InPlane) joint.onBase.direction = -feature.direction;
  if (!options.base.empty()) {
    const Part& base = namedPart(scene, "--base", options.base);
    joint.base = base.id;
    joint.onBase = inFrame(joint.onBase, base.worldFromPart);
  }
  const JointId id = scene.addJoint(joint);
  writeSceneFile(scene, options.scene);
  print(oneLine(fmt::format("wrote {}: joint {}, {}", options.scene, scene.joints().size(),
                            jointText(scene, scene.getJoint(id)))) +
        "\n");
}

void runSceneRelease(const ReleaseOptions& options) {
  Scene scene = readSceneFile(options.scene);
  std::vector<JointId> released;
  for (const std::size_t number : options.numbers) {
    if (number == 0 || number > scene.joints().size()) {
      throw UsageError(
          "NUMBER", fmt::format("there is no joint {}", number),
          fmt::format("give numbers from 1 to {}, as nearfit-cli info lists them", scene.joints().size()));
    }
    released.push_back(scene.joints()[number - 1].id);
  }
  std::ranges::sort(released);
  const auto repeated = std::ranges::unique(released);
  released.erase(repeated.begin(), repeated.end());
  for (const JointId id : released)
    scene.removeJoint(id);
  writeSceneFile(scene, options.scene);
  print(oneLine(fmt::format("wrote {}: {} joint{} left", options.scene, scene.joints().size(),
                            scene.joints().size() == 1 ? "" : "s")) +
        "\n");
}

constexpr const char* kKeepFooter =
    "The part is kept where it stands: FEATURE says, in the world frame, where its feature and that of the\n"
    "base are now.\n"
    "axis   x,y,z,dx,dy,dz: a point on the axis [m] and its direction. The part slides along it and turns\n"
    "       about it.\n"
    "plane  x,y,z,dx,dy,dz: a point in the plane [m] and the outward normal of the part's face. The part\n"
    "       slides in the plane and turns about the normal.\n"
    "point  x,y,z [m]. The part turns about it.\n"
    "The scene file is replaced.\n"
    "Example: nearfit-cli scene keep fit.nearfit Peg axis --at 0,0,0,0,0,1 --base Hole";

}  // namespace

void addSceneKeep(CLI::App& scene) {
  const auto options = std::make_shared<KeepOptions>();
  CLI::App* command =
      scene.add_subcommand("keep", "Adds a joint that keeps a part on an axis, in a plane or to a point.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("part", options->part, "Name of the part to keep")->required()->type_name("PART");
  command->add_option("kind", options->kind, "axis, plane or point")->required()->type_name("KIND");
  command->add_option("--at", options->feature, "Where the feature is now, in the world frame; see below")
      ->required()
      ->type_name("FEATURE");
  command->add_option("--base", options->base, "Name of the part to keep it on; default: the world")
      ->type_name("NAME");
  command->footer(kKeepFooter);
  command->callback([options] { runSceneKeep(*options); });
}

void addSceneRelease(CLI::App& scene) {
  const auto options = std::make_shared<ReleaseOptions>();
  CLI::App* command = scene.add_subcommand("release", "Removes joints.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("number", options->numbers, "Numbers of the joints, as nearfit-cli info lists them")
      ->required()
      ->type_name("NUMBER");
  command->footer(
      "The parts stay where they are. The scene file is replaced.\n"
      "Example: nearfit-cli scene release fit.nearfit 2");
  command->callback([options] { runSceneRelease(*options); });
}

}  // namespace nearfit::cli
