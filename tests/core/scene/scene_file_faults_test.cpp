#include <limits>
#include <random>
#include <tuple>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "tests/core/scene/scene_file_fixture.h"

namespace nearfit::scene_file_faults_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;
class SceneFileFaults : public test::SceneFileFixture {};

TEST_F(SceneFileFaults, MissingFileIsToldByName) {
  EXPECT_THROW(readSceneFile(folder_.path() / "none.nearfit"), FileError);
  EXPECT_THROW(readSceneFile(folder_.path()), FileError);
}

TEST_F(SceneFileFaults, UnknownVersionSaysWhichOneThisProgramReads) {
  EXPECT_THAT(errorWith("/nearfit", 8),
              AllOf(HasSubstr("fit.nearfit: nearfit: "), HasSubstr("version 8"),
                    HasSubstr("reads versions 1 to 7"), HasSubstr("newer Nearfit")));
  EXPECT_THAT(errorWith("/nearfit", 0), HasSubstr("with the Nearfit that made it"));
  EXPECT_THAT(errorWith("/nearfit", 1.5), HasSubstr("this is version 1.5"));
  EXPECT_THAT(errorWith("/nearfit", "1"), HasSubstr("nearfit: it is of type string"));
  EXPECT_THAT(errorOf(R"({"asset": {"version": "2.0"}})"), HasSubstr("not a Nearfit scene"));
  EXPECT_THAT(errorOf("[]"), HasSubstr("it is of type array, but an object is expected"));
}

TEST_F(SceneFileFaults, InvalidRepairSaysWhich) {
  EXPECT_THAT(errorWithout("/parts/0", "repairs"), HasSubstr("parts[0]"));
  EXPECT_THAT(errorWith("/parts/0/repairs/0/kind", "melt"),
              AllOf(HasSubstr("parts[0].repairs[0].kind"), HasSubstr("\"fillHoles\"")));
  for (const Json& size : {Json(0), Json(-1.0), Json(1e9), Json("1e-5"), Json()})
    EXPECT_THAT(errorWith("/parts/0/repairs/0/size", size), HasSubstr("parts[0].repairs[0].size")) << size;
  EXPECT_THAT(errorWith("/parts/0/repairs", Json::array_t(101, {{"kind", "orient"}, {"size", 0}})),
              HasSubstr("more than 100 repairs"));
  EXPECT_THAT(errorWith("/parts/0/repairs/0/size", 1e5), HasSubstr("leaves no face"))
      << "all becomes one vertex";
}

TEST_F(SceneFileFaults, TwoGroupsAreNotOfOneAge) {
  for (Json& group : json_["groups"])
    group["age"] = 1;
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("groups[1].age: 1 is not a place of its own"));
}

TEST_F(SceneFileFaults, MissingMeshSaysWhichFileAndPart) {
  std::filesystem::remove(folder_.path() / "meshes/peg.obj");
  EXPECT_THAT(errorOf(json_.dump()), AllOf(HasSubstr("fit.nearfit: parts[1].mesh: "),
                                           HasSubstr("meshes/peg.obj is missing; put it back")));
}

TEST_F(SceneFileFaults, ChangedMeshSaysSoAndWhatToDo) {
  folder_.write("meshes/peg.obj", test::objText(test::tetrahedronMesh(2)));
  EXPECT_THAT(errorOf(json_.dump()), AllOf(HasSubstr("fit.nearfit: parts[1].sha256: "),
                                           HasSubstr("SHA-256 differs"), HasSubstr("put the old file back")));
  folder_.write("meshes/peg.obj", "no mesh at all");
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("SHA-256 differs"));
}

TEST_F(SceneFileFaults, ChangedMeshIsTakenAndListedWhereThatIsAskedFor) {
  const std::filesystem::path peg = folder_.path() / "meshes/peg.obj";
  folder_.write("meshes/peg.obj", test::objText(test::tetrahedronMesh(2)));
  const std::filesystem::path file = folder_.write("fit.nearfit", json_.dump());
  std::vector<std::filesystem::path> changed;
  const Scene scene = readSceneFile(file, {}, &changed);
  ASSERT_THAT(changed, ElementsAre(std::filesystem::weakly_canonical(peg)));
  EXPECT_EQ(scene.parts()[1]->geometry->mesh.triangles().size(), 4U);
  EXPECT_NE(scene.parts()[1]->geometry->sha256, json_["parts"][1]["sha256"].get<std::string>());
  // Poses are those of the file.
  EXPECT_EQ(scene.parts()[1]->worldFromPart.translation.x, json_["parts"][1]["position"][0].get<double>());
  folder_.write("meshes/peg.obj", "no mesh at all");
  EXPECT_THROW(readSceneFile(file, {}, &changed), FileError);
}

TEST_F(SceneFileFaults, PartsThatShareAMeshMustAgreeOnItsHash) {
  EXPECT_THAT(errorWith("/parts/2/sha256", std::string(64, '0')), HasSubstr("parts[2].sha256: "));
}

TEST_F(SceneFileFaults, MalformedFileIsToldByLineAndColumn) {
  std::string text = test::readBytes(file_);
  const std::size_t colon = text.find(':', text.find('\n', text.find('\n') + 1));
  text[colon] = ';';
  const std::size_t column = colon - text.rfind('\n', colon);
  EXPECT_THAT(errorOf(text),
              HasSubstr("fit.nearfit:3:" + std::to_string(column) + ": this is not valid JSON"));
}

TEST_F(SceneFileFaults, EveryFieldIsCheckedAndNamed) {
  const std::string longName(300, 'x');
  const std::vector<std::tuple<std::string, Json, std::string>> faults = {
      {"/units", 1, "units: it is of type number"},
      {"/units/length", "mm", "units.length: this unit is not known; give values in m"},
      {"/haptics", nullptr, "haptics: it is of type null, but an object is expected"},
      {"/haptics/mode", "soft", "haptics.mode: this value is not known; give \"proxy\" or \"springs\""},
      {"/haptics/springs", 1, "haptics.springs: it is of type number"},
      {"/haptics/springs/cutoff", 0, "haptics.springs.cutoff: 0 m is out of range"},
      {"/haptics/springs/cutoff", "1", "haptics.springs.cutoff: it is of type string"},
      {"/haptics/springs/stiffness", -1, "haptics.springs.stiffness: -1 N/m^2 is out of range"},
      {"/haptics/springs/damping", 1e300, "haptics.springs.damping: 1e+300 N s/m is out of range"},
      {"/haptics/springs/law", "cubic", "haptics.springs.law: this value is not known; give \"linear\""},
      {"/haptics/proxy/margin", 0,
       "haptics.proxy.margin: 0 m is out of range; give a value from 1e-09 to 1 m"},
      {"/haptics/proxy/margin", 0.5, "haptics.proxy.margin: 0.5 m is greater than the cutoff"},
      {"/haptics/proxy/friction", -0.1, "haptics.proxy.friction: -0.1 is out of range"},
      {"/haptics/coupling/automatic", 1, "haptics.coupling.automatic: it is of type number"},
      {"/haptics/coupling/stiffness", 1e7, "haptics.coupling.stiffness: 10000000 N/m is out of range"},
      {"/haptics/coupling/damping", -1, "haptics.coupling.damping: -1 N s/m is out of range"},
      {"/haptics/coupling/rotationalStiffness", -1,
       "haptics.coupling.rotationalStiffness: -1 N m/rad is out"},
      {"/haptics/coupling/rotationalDamping", "", "haptics.coupling.rotationalDamping: it is of type string"},
      {"/haptics/weight/weight", 0, "haptics.weight.weight: it is of type number, but true or false"},
      {"/haptics/weight/inertia", nullptr, "haptics.weight.inertia: it is of type null"},
      {"/haptics/weight/gravity", {0, 1}, "haptics.weight.gravity: it has 2 elements, but 3 are expected"},
      {"/haptics/weight/gravity", {0, 0, 2000}, "haptics.weight.gravity: 2000 m/s^2 is out of range"},
      {"/haptics/mapping/scale", 0, "haptics.mapping.scale: 0 is out of range"},
      {"/haptics/mapping/orientation", {1, 1, 0, 0}, "haptics.mapping.orientation: its length is 1.414"},
      {"/haptics/mapping/translationLocks", {true}, "haptics.mapping.translationLocks: it has 1 elements"},
      {"/haptics/mapping/rotationLocks", {true, 1, true}, "haptics.mapping.rotationLocks[1]: it is of type"},
      {"/parts/1/density", 0, "parts[1].density: 0 kg/m^3 is out of range; give a value from 0.001 to"},
      {"/parts/1/density", "steel", "parts[1].density: it is of type string"},
      {"/moving", 3, "moving: it is of type number"},
      {"/moving", "Pin", "moving: there is no part \"Pin\""},
      {"/moving", "Hole \xC3\xA4", "moving: this part is locked"},
      {"/parts", nullptr, "parts: it is of type null, but an array is expected"},
      {"/parts/1", 7, "parts[1]: it is of type number, but an object is expected"},
      {"/parts/1/name", "", "parts[1].name: a part's name is empty"},
      {"/parts/1/name", "a\nb", "parts[1].name: a part's name holds control characters"},
      {"/parts/1/name", longName, "parts[1].name: it is longer than 200 bytes"},
      {"/parts/2/name", "Peg", "parts[2].name: parts[1] has the same name"},
      {"/parts/1/mesh", "", "parts[1].mesh: it is empty"},
      {"/parts/1/mesh", std::string("meshes/peg.obj\0.stl", 19), "parts[1].mesh: it holds a NUL character"},
      {"/parts/1/mesh", std::string(5000, 'x'), "parts[1].mesh: it is longer than 4095 bytes"},
      {"/parts/1/mesh", std::string(4000, 'x'), "parts[1].mesh: the mesh file"},
      {"/parts/1/mesh", "..", "parts[1].mesh: "},
      {"/parts/1/mesh", "/dev/zero", "parts[1].mesh: /dev/zero: "},
      {"/parts/1/sha256", "abc", "parts[1].sha256: it is not a SHA-256"},
      {"/parts/1/sha256", std::string(64, 'g'), "parts[1].sha256: it is not a SHA-256"},
      {"/parts/1/metresPerUnit", 0, "parts[1].metresPerUnit: 0 metres per unit is out of range"},
      {"/parts/1/position", {0, 0}, "parts[1].position: it has 2 elements, but 3 are expected"},
      {"/parts/1/position", {0, 0, "1"}, "parts[1].position[2]: it is of type string"},
      {"/parts/1/position", {0, 0, 1e10}, "parts[1].position: a coordinate of 10000000000 m is out of range"},
      {"/parts/1/quaternion", {0, 0, 0, 0}, "parts[1].quaternion: its length is 0, not 1"},
      {"/parts/1/quaternion", {1, 1, 0, 0}, "parts[1].quaternion: its length is 1.414"},
      {"/parts/1/quaternion", {1e200, 0, 0, 0}, "parts[1].quaternion: its length is inf"},
      {"/parts/1/colour", {0, 0, 1.5}, "parts[1].colour[2]: 1.5 is out of range"},
      {"/parts/1/colour", "#ffffff", "parts[1].colour: it is of type string"},
      {"/parts/1/visible", 1, "parts[1].visible: it is of type number, but true or false is expected"},
      {"/groups", nullptr, "groups: it is of type null, but an array is expected"},
      {"/groups/1", 7, "groups[1]: it is of type number, but an object is expected"},
      {"/groups/1/name", "", "groups[1].name: a group's name is empty"},
      {"/groups/1/name", "a\nb", "groups[1].name: a group's name holds control characters"},
      {"/groups/1/name", longName, "groups[1].name: it is longer than 200 bytes"},
      {"/groups/1/locked", 0, "groups[1].locked: it is of type number"},
      // Neither itself nor one behind it, so that none can hold itself.
      {"/groups/1/group", 1,
       "groups[1].group: 1 is not the number of one of the 1 groups; give the number of an earlier group"},
      {"/groups/1/group", 2, "groups[1].group: 2 is not the number of one of the 1 groups"},
      {"/groups/1/group", -1, "groups[1].group: -1 is not the number of one of the 1 groups"},
      {"/groups/2/group", 0.5, "groups[2].group: 0.5 is not the number of one of the 2 groups"},
      {"/groups/2/group", "Spare", "groups[2].group: it is of type string"},
      {"/groups/0/age", 0, "groups[1].age: it is missing"},
      {"/groups/0/age", 3, "groups[0].age: 3 is not a place of its own among the 3 groups"},
      {"/groups/0/age", -1, "groups[0].age: -1 is not a place of its own"},
      {"/groups/0/age", 0.5, "groups[0].age: 0.5 is not a place of its own"},
      {"/parts/1/group", 3, "parts[1].group: 3 is not the number of one of the 3 groups"},
      {"/parts/1/group", 1e300, "parts[1].group: 1e+300 is not the number of one of the 3 groups"},
      {"/parts/1/group", false, "parts[1].group: it is of type boolean"},
      {"/parts/1/opacity", 0, "parts[1].opacity: 0 is out of range; give a value from 0.05 to 1"},
      {"/parts/1/opacity", 1.01, "parts[1].opacity: 1.01 is out of range"},
      {"/parts/1/opacity", nullptr, "parts[1].opacity: it is of type null"},
      {"/parts/1/pivot", {0, 0}, "parts[1].pivot: it has 2 elements, but 3 are expected"},
      {"/parts/1/pivot",
       {0, 2e9, 0},
       "parts[1].pivot: a coordinate of 2000000000 m is out of range; stay within"},
      {"/parts/1/pivot", true, "parts[1].pivot: it is of type boolean"},
      {"/parts/1/wasVisible", 1, "parts[1].wasVisible: it is of type number, but true or false is expected"},
      {"/moving", "Peg 2", "moving: this part is locked"},
      {"/joints", nullptr, "joints: it is of type null, but an array is expected"},
      {"/joints/1", 7, "joints[1]: it is of type number, but an object is expected"},
      {"/joints/0/kind", "weld",
       "joints[0].kind: this value is not known; give \"axis\", \"plane\" or \"point\""},
      {"/joints/0/part", "Pin", "joints[0].part: there is no part \"Pin\"; name a part"},
      {"/joints/0/part", nullptr, "joints[0].part: it is of type null"},
      {"/joints/0/base", "Pin", "joints[0].base: there is no part \"Pin\"; name a part, or give null"},
      {"/joints/0/base", "Peg", "joints[0].base: a part cannot be kept on itself"},
      {"/joints/0/onPart", {0, 0, 0}, "joints[0].onPart: it is of type array, but an object is expected"},
      {"/joints/0/onPart/point", {0, 0}, "joints[0].onPart.point: it has 2 elements, but 3 are expected"},
      {"/joints/2/onBase/point",
       {0, 2e9, 0},
       "joints[2].onBase.point: a coordinate of 2000000000 m is out of"},
      {"/joints/0/onPart/direction",
       {0, 0, 0},
       "joints[0].onPart.direction: its length is 0, not 1; give a unit"},
      {"/joints/1/onBase/direction", {1e200, 1e200, 0}, "joints[1].onBase.direction: its length is inf"},
      {"/joints/0/on", 1, "joints[0].on: it is of type number, but true or false is expected"},
      {"/parts/1/locked", "no", "parts[1].locked: it is of type string"},
      {"/pairRules", nullptr, "pairRules: it is of type null, but an array is expected"},
      {"/pairRules/0/kind", "ignore", "pairRules[0].kind: this value is not known; give \"leaveOut\""},
      {"/pairRules/0/part", "", "pairRules[0]: it is empty; give a name, or * for any"},
      {"/pairRules/0/other", "a\\", "pairRules[0]: nothing follows the last backslash"},
      {"/pairRules/0/interference", 1e-3, "pairRules[0]: only a press fit has an interference"},
      {"/pairRules/1/part", "Peg", "pairRules[1]: it takes no names"},
      {"/pairRules/3/interference", 0, "pairRules[3]: 0 m is out of range"},
      {"/pairRules/3/interference", 2, "pairRules[3]: 2 m is out of range"},
      {"/pairRules/3/part", std::string(401, 'x'), "pairRules[3].part: it is longer than 400 bytes"},
      {"/pairRecords/0/part", 3, "pairRecords[0].part: 3 is not the number of one of the 3 parts"},
      {"/pairRecords/0/part", -1, "pairRecords[0].part: -1 is not the number"},
      {"/pairRecords/0/other", 0, "pairRecords[0].other: 0 is not the number of one of the 3 parts after"},
      {"/pairRecords/0/other", 1.5, "pairRecords[0].other: 1.5 is not the number"},
      {"/pairRecords/0/verdict", "bad", "pairRecords[0].verdict: this value is not known"},
      {"/pairRecords/0/state", "open", "pairRecords[0].state: this value is not known"},
      {"/pairRecords/0/reason", "", "pairRecords[0]: it is accepted without a reason"},
      {"/pairRecords/0/reason", "a\nb", "pairRecords[0]: it is too long, or not printable"},
      {"/pairRecords/0/distance", -1, "pairRecords[0]: a length is negative"},
      {"/pairRecords/0/depth", -1, "pairRecords[0]: a length is negative"},
  };
  for (const auto& [pointer, value, message] : faults) {
    const std::string error = errorWith(pointer, value);
    EXPECT_NE(error, "") << pointer;
    EXPECT_THAT(error, HasSubstr(message));
    EXPECT_THAT(error, HasSubstr("fit.nearfit"));
  }
}

TEST_F(SceneFileFaults, EveryKeyIsNeeded) {
  for (const auto& [key, value] : json_.items())
    EXPECT_NE(errorWithout("", key), "") << key;
  for (const auto& [section, values] : json_["haptics"].items()) {
    EXPECT_THAT(errorWithout("/haptics", section), HasSubstr("haptics." + section + ": it is missing"));
    if (!values.is_object()) continue;
    for (const auto& [key, value] : values.items()) {
      EXPECT_THAT(errorWithout("/haptics/" + section, key),
                  HasSubstr(fmt::format("haptics.{}.{}: it is missing", section, key)));
    }
  }
  for (const auto& [key, value] : json_["parts"][2].items()) {
    EXPECT_THAT(errorWithout("/parts/2", key), HasSubstr("parts[2]." + key + ": it is missing"));
  }
  for (const auto& [key, value] : json_["groups"][2].items()) {
    EXPECT_THAT(errorWithout("/groups/2", key), HasSubstr("groups[2]." + key + ": it is missing"));
  }
  for (const auto& [key, value] : json_["joints"][0].items()) {
    EXPECT_THAT(errorWithout("/joints/0", key), HasSubstr("joints[0]." + key + ": it is missing"));
  }
  for (const auto& [key, value] : json_["pairRules"][3].items())
    EXPECT_THAT(errorWithout("/pairRules/3", key), HasSubstr("pairRules[3]." + key + ": it is missing"));
  for (const auto& [key, value] : json_["pairRecords"][0].items())
    EXPECT_THAT(errorWithout("/pairRecords/0", key), HasSubstr("pairRecords[0]." + key + ": it is missing"));
  for (const char* key : {"point", "direction"}) {
    EXPECT_THAT(errorWithout("/joints/0/onBase", key),
                HasSubstr(fmt::format("joints[0].onBase.{}: it is missing", key)));
  }
}

TEST_F(SceneFileFaults, Version1IsCheckedAndNamedAsItSaysThings) {
  json_ = version1();
  EXPECT_THAT(errorWith("/springs/cutoff", 0), HasSubstr("fit.nearfit: springs.cutoff: 0 m is out of range"));
  EXPECT_THAT(errorWith("/springs/law", "cubic"), HasSubstr("springs.law: this value is not known"));
  EXPECT_THAT(errorWith("/springs/damping", nullptr), HasSubstr("springs.damping: it is of type null"));
  for (const auto& [key, value] : json_["springs"].items())
    EXPECT_THAT(errorWithout("/springs", key), HasSubstr("springs." + key + ": it is missing"));
  EXPECT_THAT(errorWithout("", "springs"), HasSubstr("springs: it is missing"));
  // What a version does not know is ignored in it.
  EXPECT_EQ(errorWith("/haptics", "none"), "");
  EXPECT_EQ(errorWith("/parts/0/density", -1), "");
}

TEST_F(SceneFileFaults, Version2WithTheSpringsOfVersion1SaysWhatIsMissing) {
  json_ = version1();
  json_["nearfit"] = 2;
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("haptics: it is missing"));
}

TEST_F(SceneFileFaults, WhatVersion7SaysIsIgnoredInVersion6) {
  json_ = version6();
  EXPECT_EQ(errorWith("/pairRules", "none"), "");
  EXPECT_EQ(errorWith("/pairRecords", "none"), "");
}

TEST_F(SceneFileFaults, TooManyRulesAndRecordsOrTwoOfOnePairAreRefused) {
  const Json rule = json_["pairRules"][0], record = json_["pairRecords"][0];
  json_["pairRecords"].push_back(record);
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("pairRecords[2]: there is an earlier finding of these parts"));
  json_["pairRecords"] = Json::array_t(kMaxPairRecords + 1, record);
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("pairRecords: there are more than 20000 findings"));
  dropPairs();
  json_["pairRules"] = Json::array_t(kMaxPairRules + 1, rule);
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("pairRules: there are more than 1000 rules"));
}

TEST_F(SceneFileFaults, WhatVersion6SaysIsIgnoredInVersion5) {
  json_ = version5();
  EXPECT_EQ(errorWith("/movingGroup", "none"), "");
  EXPECT_EQ(errorWith("/parts/0/shape", "none"), "");
}

TEST_F(SceneFileFaults, AMovingGroupThatCannotMoveIsRefused) {
  EXPECT_THAT(errorWith("/movingGroup", 2), HasSubstr("movingGroup: a part is in hand too"));
  json_["moving"] = nullptr;
  EXPECT_EQ(errorWith("/movingGroup", 2), "");
  EXPECT_EQ(errorWith("/movingGroup", 1), "");
  EXPECT_THAT(errorWith("/movingGroup", 0), HasSubstr("is locked and cannot be moved"));
  EXPECT_THAT(errorWith("/movingGroup", 3), HasSubstr("3 is not the number of one of the 3 groups"));
  EXPECT_THAT(errorWith("/movingGroup", "Pegs"), HasSubstr("movingGroup: it is of type string"));
  json_["parts"][2]["group"] = 0;
  json_["parts"][1]["group"] = nullptr;
  EXPECT_THAT(errorWith("/movingGroup", 2), HasSubstr("this group has no parts"));
  json_["parts"][1]["group"] = 2;
  json_["parts"][1]["locked"] = true;
  EXPECT_THAT(errorWith("/movingGroup", 1), HasSubstr("is locked and cannot be moved"));
  json_["parts"][1]["locked"] = false;
  json_["groups"][2]["locked"] = true;
  EXPECT_THAT(errorWith("/movingGroup", 1), HasSubstr("is locked and cannot be moved"));
}

TEST_F(SceneFileFaults, ShapesAndKindsOfFilesMustFit) {
  const Json shape = {{"key", "1"}, {"chord", 0}, {"angle", 0}};
  EXPECT_THAT(errorWithout("/parts/1", "shape"), HasSubstr("parts[1].shape: it is missing"));
  EXPECT_THAT(errorWith("/parts/1/shape", shape),
              HasSubstr("parts[1].shape: the part's file is not a CAD document"));
  json_["parts"][1]["mesh"] = "meshes/peg.step";
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("parts[1].shape: the part's file is a CAD document"));
  json_["parts"][1]["shape"] = shape;
  EXPECT_THAT(errorWith("/parts/1/shape/key", ""), HasSubstr("parts[1].shape.key: it is empty"));
  EXPECT_THAT(errorWith("/parts/1/shape/key", std::string(1001, 'k')), HasSubstr("longer than 1000 bytes"));
  EXPECT_THAT(errorWith("/parts/1/shape/chord", -1), HasSubstr("parts[1].shape: -1 m is out of range"));
  EXPECT_THAT(errorWith("/parts/1/shape/angle", 2), HasSubstr("parts[1].shape: 2 rad is out of range"));
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("peg.step is missing"));
}

TEST_F(SceneFileFaults, WhatVersion5SaysIsIgnoredInVersion4) {
  json_ = version4();
  EXPECT_EQ(errorWith("/joints", "none"), "");
}

TEST_F(SceneFileFaults, TooManyJointsAreRefusedBeforeAnyMeshIsLoaded) {
  const Json joint = json_["joints"][2];
  std::filesystem::remove(folder_.path() / "meshes/peg.obj");
  json_["joints"] = Json::array();
  for (std::size_t i = 0; i <= kMaxJointsPerPart; ++i)
    json_["joints"].push_back(joint);
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("joints[3].part: the part has more than 3 joints"));
  for (std::size_t i = 0; i <= kMaxJoints; ++i)
    json_["joints"].push_back(joint);
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("joints: there are more than 1000 joints"));
}

TEST_F(SceneFileFaults, WhatVersion4SaysIsIgnoredInVersion3) {
  json_ = version3();
  EXPECT_EQ(errorWith("/parts/0/pivot", "none"), "");
}

TEST_F(SceneFileFaults, WhatVersion3SaysIsIgnoredInVersion2) {
  json_ = version2();
  EXPECT_EQ(errorWith("/groups", "none"), "");
  EXPECT_EQ(errorWith("/parts/0/opacity", -1), "");
  EXPECT_EQ(errorWith("/parts/0/group", 5), "");
}

TEST_F(SceneFileFaults, GroupsTooDeepOrTooManyAreRefused) {
  const Json group = {{"name", "g"}, {"group", nullptr}, {"locked", false}};
  json_["groups"] = Json::array();
  for (std::size_t i = 0; i <= kMaxGroupDepth; ++i) {
    json_["groups"].push_back(group);
    if (i > 0) json_["groups"][i]["group"] = i - 1;
  }
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("groups[32].group: groups are nested more than 32 deep"));
  json_["groups"] = Json::array();
  for (std::size_t i = 0; i <= kMaxGroups; ++i)
    json_["groups"].push_back(group);
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("groups: there are more than 10000 groups"));
}

TEST_F(SceneFileFaults, TooBigAFileIsRefused) {
  EXPECT_THAT(errorOf(std::string(kMaxSceneFileBytes + 1, ' ')), HasSubstr("larger than"));
}

TEST_F(SceneFileFaults, TooManyPartsAreRefused) {
  json_["parts"] = Json::array();
  for (std::size_t i = 0; i <= kMaxSceneFileParts; ++i)
    json_["parts"].push_back(0);
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("parts: there are more than 10000 parts"));
}

TEST_F(SceneFileFaults, EveryPrefixIsRefused) {
  const std::string text = test::readBytes(file_);
  for (std::size_t length = 0; length + 2 < text.size(); ++length) {
    ASSERT_NE(errorOf(text.substr(0, length)), "") << length << " bytes";
  }
}

TEST_F(SceneFileFaults, FlippedBytesGiveAnErrorOrAScene) {
  const std::string text = test::readBytes(file_);
  std::mt19937 random(17);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = text;
    for (auto flips = 1 + random() % 3; flips > 0; --flips) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    // Anything but a scene or a FileError ends the test.
    ASSERT_NO_THROW(errorOf(damaged)) << damaged;
  }
}

TEST_F(SceneFileFaults, HostileValuesInAnyPlaceGiveAnErrorOrAScene) {
  const Json flat = json_.flatten();
  std::vector<std::string> places{"",       "/parts",   "/parts/1",          "/groups",          "/groups/1",
                                  "/units", "/haptics", "/haptics/coupling", "/parts/1/position"};
  for (const auto& [pointer, value] : flat.items())
    places.push_back(pointer);
  const std::vector<Json> hostile = {nullptr,
                                     true,
                                     -1,
                                     0,
                                     1e308,
                                     -1e-320,
                                     std::numeric_limits<std::uint64_t>::max(),
                                     "",
                                     std::string(1, '\0'),
                                     "../../../../../../etc/passwd",
                                     "/proc/self/mem",
                                     ".",
                                     std::string(100'000, 'A'),
                                     Json::array(),
                                     Json::object(),
                                     Json::array({Json::array()}),
                                     Json::array({true, true, true}),
                                     Json::array({1e308, 1e308, 1e308}),
                                     {{"nearfit", 1}}};
  for (const std::string& place : places) {
    for (const Json& value : hostile)
      ASSERT_NO_THROW(errorWith(place, value)) << place << " = " << value.dump();
  }
}

TEST_F(SceneFileFaults, MeshPathThatIsNotUtf8IsToldWhenSaving) {
  const auto odd = folder_.write("odd\xFF.obj", test::objText(test::tetrahedronMesh(1)));
  Part part;
  part.name = "Odd";
  part.geometry = loadPartGeometry(odd, 1.0);
  scene_.add(part);
  try {
    writeSceneFile(scene_, file_);
    FAIL() << "a path that is not UTF-8 was written";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("odd\\xff.obj"), HasSubstr("not UTF-8")));
  }
}

}  // namespace
}  // namespace nearfit::scene_file_faults_test
