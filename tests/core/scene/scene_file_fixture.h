#pragma once

#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test {

/// A scene of three parts, the last two of one mesh, in groups of which one is locked, each part with a joint,
/// written to `file_`; and ways to damage what was written.
class SceneFileFixture : public ::testing::Test {
 protected:
  SceneFileFixture() {
    std::filesystem::create_directory(folder_.path() / "meshes");
    const auto hole = folder_.write("meshes/hole.obj", objText(boxMesh({2, 2, 1})));
    const auto peg = folder_.write("meshes/peg.obj", objText(tetrahedronMesh(1)));
    Part part;
    part.geometry =
        loadPartGeometries(
            std::vector{MeshSource{.file = hole, .metresPerUnit = 0.001, .repairs = unusualRepairs()}})
            .front()
            .geometry;
    part.name = "Hole \xC3\xA4";
    part.wasVisible = false;
    const PartId holeId = scene_.add(part);
    const GroupId spare = scene_.addGroup({{}, "Spare", {}, false});
    const GroupId frame = scene_.addGroup({{}, "Frame \xC3\xA4", {}, false});
    part.group = scene_.addGroup({{}, "Pegs", frame, false});
    part.geometry = loadPartGeometry(peg, 0.0254);
    part.name = "Peg";
    part.colour = {0.1F, 0.2F, 0.3F};
    part.density = 7850.1;
    part.worldFromPart = {{0.5, -0.5, 0.5, 0.5}, {0.1, -1e-17, 123456.789012345}};
    part.opacity = 0.1 + 0.2;
    part.pivot = {0.1 + 0.2, -1e-17, 1e9};
    part.wasVisible = true;
    const PartId pegId = scene_.add(part);
    scene_.setMovingPart(pegId);
    part.isVisible = false;
    part.wasVisible.reset();
    part.group = spare;
    const PartId sparePegId = scene_.add(part);
    addJoints(holeId, pegId, sparePegId);
    addPairs(holeId, pegId, sparePegId);
    Part lockedHole = scene_.get(holeId);
    lockedHole.isLocked = true;
    scene_.replace(lockedHole);
    scene_.replaceGroup({spare, "Spare", {}, true});
    scene_.setHaptics(unusualHaptics());
    writeSceneFile(scene_, file_);
    json_ = nlohmann::json::parse(readBytes(file_));
  }

  /// One of each kind.
  void addJoints(PartId hole, PartId peg, PartId sparePeg) {
    Joint joint;
    joint.kind = JointKind::OnAxis;
    joint.part = peg;
    joint.base = hole;
    joint.onPart = {{0.1 + 0.2, -1e-17, 1e9}, {0.6, 0.0, 0.8}};
    joint.onBase = {{1.0 / 3.0, 2.0, 3.0}, {0.0, -1.0, 0.0}};
    scene_.addJoint(joint);
    joint.kind = JointKind::InPlane;
    joint.part = hole;
    joint.base = peg;
    scene_.addJoint(joint);
    joint.kind = JointKind::ToPoint;
    joint.part = sparePeg;
    joint.base.reset();
    joint.isOn = false;
    scene_.addJoint(joint);
  }

  /// A rule of each kind, and records of two pairs.
  void addPairs(PartId hole, PartId peg, PartId sparePeg) {
    scene_.setPairRules({{PairRuleKind::LeaveOut, "Peg*", "Hole \xC3\xA4"},
                         {PairRuleKind::SameGroup},
                         {PairRuleKind::Touching, "\\*", "?"},
                         {PairRuleKind::PressFit, "Peg", "*", 1e-5 / 3.0}});
    scene_.setPairRecords(
        {{{hole, peg}, PairVerdict::Clash, 0.0, 1e-4 / 3.0, FindingState::Accepted, "fits \xC3\xA4"},
         {{peg, sparePeg}, PairVerdict::Near, 0.1 + 0.2, {}, FindingState::New, ""}});
  }

  /// One with a size of many digits, and one without.
  static MeshRepairs unusualRepairs() { return {{RepairKind::Weld, 1e-5 / 3.0}, {RepairKind::Orient}}; }

  /// No value is the default.
  static HapticSettings unusualHaptics() {
    HapticSettings haptics;
    haptics.mode = HapticMode::Springs;
    haptics.springs = {0.1 + 0.2, 1e6 / 3, 0.7, SpringLaw::Printed};
    haptics.proxy = {1e-3 / 3, 0.35};
    haptics.coupling = {false, 1e3 / 7, 0.1, 0.1 + 0.7, 1e-3 / 3};
    haptics.weight = {true, true, {0.1, -9.7, 1e-17}};
    haptics.mapping = {12.5, {0.5, -0.5, 0.5, 0.5}, {true, false, true}, {false, true, false}};
    return haptics;
  }

  /// The scene as version 6 of the format says it.
  nlohmann::json version6() const {
    nlohmann::json json = json_;
    json["nearfit"] = 6;
    json.erase("pairRules");
    json.erase("pairRecords");
    return json;
  }

  /// The scene as version 5 of the format says it.
  nlohmann::json version5() const {
    nlohmann::json json = version6();
    json["nearfit"] = 5;
    for (nlohmann::json& part : json["parts"]) {
      part.erase("repairs");
      part.erase("shape");
    }
    json.erase("movingGroup");
    return json;
  }

  /// The scene as version 4 of the format says it.
  nlohmann::json version4() const {
    nlohmann::json json = version5();
    json["nearfit"] = 4;
    json.erase("joints");
    return json;
  }

  /// The scene as version 3 of the format says it.
  nlohmann::json version3() const {
    nlohmann::json json = version4();
    json["nearfit"] = 3;
    for (nlohmann::json& part : json["parts"])
      part.erase("pivot");
    return json;
  }

  /// The scene as version 2 of the format says it.
  nlohmann::json version2() const {
    nlohmann::json json = version3();
    json["nearfit"] = 2;
    json.erase("groups");
    for (nlohmann::json& part : json["parts"]) {
      for (const char* key : {"opacity", "group", "wasVisible"})
        part.erase(key);
    }
    return json;
  }

  /// The scene as version 1 of the format says it.
  nlohmann::json version1() const {
    nlohmann::json json = version2();
    json["nearfit"] = 1;
    json["springs"] = json["haptics"]["springs"];
    json.erase("haptics");
    for (nlohmann::json& part : json["parts"])
      part.erase("density");
    return json;
  }

  /// Takes the repairs out of the scene as the file says it, as older versions have none.
  void dropRepairs() {
    for (nlohmann::json& part : json_["parts"])
      part["repairs"] = nlohmann::json::array();
  }

  /// Takes the rules and records of pairs out of it.
  void dropPairs() { json_["pairRules"] = json_["pairRecords"] = nlohmann::json::array(); }

  /// What reading the file gives when it holds this; "" when it is a scene.
  std::string errorOf(const std::string& text) {
    folder_.write("fit.nearfit", text);
    try {
      readSceneFile(file_);
    } catch (const FileError& e) {
      return e.what();
    }
    return "";
  }
  std::string errorWith(const std::string& pointer, const nlohmann::json& value) {
    nlohmann::json json = json_;
    json[nlohmann::json::json_pointer(pointer)] = value;
    return errorOf(json.dump());
  }
  std::string errorWithout(const std::string& pointer, const std::string& key) {
    nlohmann::json json = json_;
    json[nlohmann::json::json_pointer(pointer)].erase(key);
    return errorOf(json.dump());
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "fit.nearfit";
  Scene scene_;
  nlohmann::json json_;
};

}  // namespace nearfit::test
